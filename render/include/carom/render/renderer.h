// Turns draw lists into pixels. Needs no display. A renderer may be used only by the thread that created it.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "carom/render/backend.h"
#include "carom/render/draw_list.h"
#include "carom/render/image.h"
#include "carom/render/kept_image.h"

namespace carom::render {

class Renderer {
  public:
    /// @throws RenderError if the library is missing (the message names its package) or has no OpenGL 3.3
    explicit Renderer(Backend backend = Backend::kAuto);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Draws the list. If table and camera are unchanged, only the parts that changed are redrawn; the
    /// pixels are the same as those of a complete drawing.
    void draw(const DrawList& list);

    /// Sets a function that is called after every finished pass over
    /// the table; it may throw to stop. By default it is empty.
    void on_table(std::function<void(int done, int total)> pass);

    /// Copies the pixels of the last draw().
    void read(Image& image);

    /// As above, but copies only the pixels that may differ from those in the image.
    void read(KeptImage& image);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace carom::render
