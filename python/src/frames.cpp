// Pictures of a record as arrays.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "carom/engine/tolerances.h"
#include "carom/render/draw_list.h"
#include "carom/render/error.h"
#include "carom/render/kept_image.h"
#include "carom/render/renderer.h"
#include "carom/render/sequence.h"
#include "native.h"

namespace carom::python {
namespace {

/// Draws one record, frame by frame. OpenGL belongs to the thread that made it, and to one at a time.
class Frames {
  public:
    Frames(std::shared_ptr<const Record> record, const std::string& camera, int width, int height,
           const std::string& backend, const std::string& overlays)
        : record_(std::move(record)), size_{width, height} {
        render::StageOptions options;
        options.camera = camera;
        options.size = size_;
        options.overlay = render::parse_overlay(overlays);
        if (camera == "scene") {
            options.camera = record_->render.camera;
            options.view.eye = record_->render.eye;
            options.view.target = record_->render.target;
        }
        const render::Backend chosen = render::backend_from_name(backend);
        const nb::gil_scoped_release no_gil;
        stage_ = std::make_unique<render::Stage>(*record_, options);
        renderer_ = std::make_unique<render::Renderer>(chosen);
    }

    void draw(double time, const Flat<std::uint8_t>& out) {
        if (std::this_thread::get_id() != maker_)
            throw render::RenderError("frames must be drawn by the thread that drew the first one");
        const nb::gil_scoped_release no_gil;
        renderer_->draw(stage_->at(time));
        renderer_->read(image_);
        const std::uint8_t* from = image_.image().rgbx.data();
        std::uint8_t* to = out.data();
        for (std::size_t pixels = out.size() / 3; pixels > 0; --pixels, from += 4)
            to = std::copy_n(from, 3, to);
    }

  private:
    std::shared_ptr<const Record> record_;
    FrameSize size_;
    std::thread::id maker_ = std::this_thread::get_id();
    std::unique_ptr<render::Stage> stage_;
    std::unique_ptr<render::Renderer> renderer_;
    render::KeptImage image_;
};

}  // namespace

void add_frames(nb::module_& m) {
    nb::class_<Frames>(m, "Frames")
        .def("__init__",
             [](Frames* frames, const NativeRecord& r, const std::string& camera, int width, int height,
                const std::string& backend, const std::string& overlays) {
                 new (frames) Frames(r.record, camera, width, height, backend, overlays);
             })
        .def("draw", &Frames::draw, nb::arg("time"), nb::arg("out").noconvert());
    m.attr("MAX_IMAGE_SIZE") = kMaxImageSize;
    m.def("frame_count", render::frame_count);
    m.def("frame_time", render::frame_time);
}

}  // namespace carom::python
