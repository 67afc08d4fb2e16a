// Draw lists in, pixels out. Needs no display; one renderer belongs to the thread that made it.
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
    /// @throws RenderError: no such library (names its package), or no OpenGL 3.3
    explicit Renderer(Backend backend = Backend::kOsmesa);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Starts to draw the list. If neither table nor camera changed, only what did is drawn; the pixels are
    /// those of a whole picture.
    void draw(const DrawList& list);

    /// Called, from now on, after every pass over a table while that is drawn, and the pass is then done; may
    /// throw to stop. Nothing: no pass is waited for.
    void on_table(std::function<void(int done, int total)> pass);

    /// Waits until the last draw() is done: for those who measure it.
    void finish();

    /// Copies the pixels of the last draw().
    void read(Image& image);

    /// The same, but only those that differ from what the image shows.
    void read(KeptImage& image);

    /// Those of the draw() before, while the last one goes on in
    /// the driver's threads. Needs two draws of one size before.
    void read_previous(KeptImage& image);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace carom::render
