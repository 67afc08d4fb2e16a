// Draws the table by OpenGL as seen by one camera: with many samples per pixel, or with one for a moving
// camera.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "carom/render/draw_list.h"
#include "draw/table_edges.h"
#include "draw/table_parts.h"
#include "draw/table_picture.h"
#include "draw/view.h"
#include "gl/api.h"

namespace carom::render {

class StaticLayer {
  public:
    explicit StaticLayer(const gl::Api& api);
    ~StaticLayer();
    StaticLayer(const StaticLayer&) = delete;
    StaticLayer& operator=(const StaticLayer&) = delete;

    /// Draws the table in `samples` jittered passes, averaged in linear light; passes after the first draw
    /// only the busy parts (busy_tiles.h). `on_pass`, if set, is called after every finished pass; it may
    /// throw.
    void draw(const TableMesh& table, const View& view, FrameSize size, int samples, bool less_detail,
              const std::function<void(int done, int total)>& on_pass);

    /// Draws the table in one pass. The fourth channel gets the mark of the face (table_edges.h).
    void draw_once(const TableMesh& table, FrameSize size, bool less_detail);

    /// The edges of the table of the last draw_once().
    const std::shared_ptr<const TableEdges>& edges() const { return edges_; }

    /// The picture that the last of these drew.
    const TablePicture& picture() const { return picture_; }

  private:
    struct Program {
        GLuint fragment = 0, pipeline = 0;
    };
    using Programs = std::array<Program, kPartCount>;
    Programs& programs_for(bool less_detail);
    void upload(const TableMesh& table, const TableEdges* edges, bool less_detail);
    void resize(FrameSize size);
    void set_table_uniforms(const TableMesh& table, GLuint program) const;
    void draw_parts(double jitter_x, double jitter_y, const float* depths);
    void read_color(std::vector<std::uint8_t>& rgba);
    void read_depths(std::vector<float>& depths);

    const gl::Api& api_;
    // Made when they are first needed, like the vertex program, which they share.
    std::array<Programs, 2> programs_;  ///< the second ones have less detail
    GLuint vertex_program_ = 0;
    GLint jitter_ = -1;  ///< location of its u_jitter
    TableParts parts_;   ///< without the vertices, which are in buffer_
    GLuint vertex_array_ = 0, buffer_ = 0;
    const TableMesh* uploaded_ = nullptr;
    bool less_detail_ = false;  ///< of the uploaded table
    FrameSize size_{0, 0};
    std::shared_ptr<const TableEdges> edges_;
    GLuint color_ = 0, depth_ = 0, framebuffer_ = 0;
    TablePicture picture_;
};

}  // namespace carom::render
