// The table seen by one camera, kept as textures: drawn with many samples per pixel, or with one for a camera that moves.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>

#include "carom/render/draw_list.h"
#include "draw/table_edges.h"
#include "draw/table_parts.h"
#include "gl/api.h"

namespace carom::render {

class StaticLayer {
  public:
    explicit StaticLayer(const gl::Api& api);
    ~StaticLayer();
    StaticLayer(const StaticLayer&) = delete;
    StaticLayer& operator=(const StaticLayer&) = delete;

    /// Draws the table in `samples` jittered passes, averaged in linear light. `on_pass`, if set, is called after every
    /// finished pass; it may throw.
    void draw(const TableMesh& table, FrameSize size, int samples,
              const std::function<void(int done, int total)>& on_pass);

    /// Draws the table in one pass. The fourth channel gets the mark of the face (table_edges.h).
    void draw_once(const TableMesh& table, FrameSize size);

    /// The edges of the table of the last draw_once().
    const std::shared_ptr<const TableEdges>& edges() const { return edges_; }

    GLuint color() const { return color_; }  ///< RGBA8; alpha: share of the pixel that is cloth, or the face
    /// RGBA32F: distances along the view direction at four positions in the pixel; after draw_once() the depth buffer
    GLuint occluders() const { return edges_ ? depth_ : occluders_; }
    GLuint framebuffer() const { return color_framebuffer_; }

  private:
    struct Scratch;
    struct Program {
        GLuint id = 0;
        GLint jitter = -1;  ///< location of u_jitter
    };
    using Programs = std::array<Program, kPartCount>;
    Programs make_programs(const char* output) const;
    void upload(const TableMesh& table, const TableEdges* edges, const Programs& programs);
    void resize(int width, int height);
    void set_table_uniforms(const TableMesh& table, GLuint program) const;
    void draw_parts(const Programs& programs, double jitter_x, double jitter_y);
    void draw_pass(const Scratch& scratch, int pass, int samples);
    void add_pass(const Scratch& scratch, int pass);
    void keep_depths(const Scratch& scratch, int samples);

    const gl::Api& api_;
    Programs sum_programs_, screen_programs_;  ///< of draw() and draw_once(); made when they are first needed
    TableParts parts_;                         ///< without the vertices, which are in buffer_
    GLuint add_program_, depth_program_, resolve_program_;
    GLint add_weight_;
    GLuint vertex_array_ = 0, buffer_ = 0, empty_array_ = 0;
    const TableMesh* uploaded_ = nullptr;
    int width_ = 0, height_ = 0;
    std::shared_ptr<const TableEdges> edges_;
    GLuint color_ = 0, occluders_ = 0, color_framebuffer_ = 0, occluders_framebuffer_ = 0;
    GLuint depth_ = 0, once_framebuffer_ = 0;  ///< of draw_once(), with color_
};

}  // namespace carom::render
