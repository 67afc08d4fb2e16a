// The table seen by one camera, drawn once with many samples per pixel and kept as textures.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>

#include "carom/render/draw_list.h"
#include "gl/api.h"

namespace carom::render {

class StaticLayer {
  public:
    explicit StaticLayer(const gl::Api& api);
    ~StaticLayer();
    StaticLayer(const StaticLayer&) = delete;
    StaticLayer& operator=(const StaticLayer&) = delete;

    /// Draws the table in `samples` jittered passes, averaged in linear light. again_soon: keep the memory that
    /// only drawing needs. `on_pass`, if set, is called after every finished pass; it may throw.
    void draw(const TableMesh& table, FrameSize size, int samples, bool again_soon,
              const std::function<void(int done, int total)>& on_pass);

    GLuint color() const { return color_; }  ///< RGBA8; alpha: share of the pixel that is cloth
    /// RGBA32F: distances along the view direction at four positions in the pixel
    GLuint occluders() const { return occluders_; }
    GLuint framebuffer() const { return color_framebuffer_; }

  private:
    struct Scratch;
    void upload(const TableMesh& table);
    void resize(int width, int height);
    void set_table_uniforms(const TableMesh& table, GLuint program) const;
    void draw_pass(const Scratch& scratch, int pass, int samples);
    void add_pass(const Scratch& scratch, int pass);
    void keep_depths(const Scratch& scratch, int samples);

    const gl::Api& api_;
    /// Parts in the order of drawing; kBlended: paint and shading on the cloth.
    enum Part : std::uint8_t { kCloth, kWood, kSmall, kFloor, kBlended, kParts };
    /// The vertices that one program draws.
    struct Group {
        GLuint program = 0;
        GLint jitter = -1;  ///< location of u_jitter in the program
        GLint first = 0;
        GLsizei count = 0;
    };
    std::array<Group, kParts> groups_;
    GLuint add_program_, depth_program_, resolve_program_;
    GLint add_weight_;
    GLuint vertex_array_ = 0, buffer_ = 0, empty_array_ = 0;
    const TableMesh* uploaded_ = nullptr;
    int width_ = 0, height_ = 0;
    std::unique_ptr<Scratch> scratch_;
    GLuint color_ = 0, occluders_ = 0, color_framebuffer_ = 0, occluders_framebuffer_ = 0;
};

}  // namespace carom::render
