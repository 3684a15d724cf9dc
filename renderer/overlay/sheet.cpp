#include "overlay/sheet.h"

#include "transport/aim.h"

namespace lucerna::overlay {

using namespace shared;

Sheet::Sheet(gpu::Device& device, gpu::ShaderCompiler& compiler) : device_(device), compiler_(compiler) {
  for (gpu::Buffer* view : {&view_, &film_view_})
    *view =
        gpu::Buffer(device, {.name = "sheet view", .bytes = sizeof(SheetView), .memory = gpu::Memory::host});
  gpu::make_texel_room(device, none_, "no surfaces", sizeof(vec4));
}

void Sheet::fit(const film::Film& film, uint32_t scale, const Frame& frame) {
  known_ = known_ && scale == scale_ && transport::same_view(frame, frame_);
  scale_ = scale, frame_ = frame;
  if (scale > 1)
    gpu::make_room(device_, picture_,
                   {.name = "overlay sheet",
                    .bytes = uint64_t{film.width()} * film.height() * scale * scale * sizeof(uint32_t)});
  write_views(film);
}

void Sheet::write_views(const film::Film& film) {
  const SheetView sheet{film.width(), film.height(), scale_, known_};
  const SheetView of_film{film.width(), film.height(), 1, known_ && scale_ == 1};
  view_.write(&sheet, sizeof sheet);
  film_view_.write(&of_film, sizeof of_film);
}

void Sheet::enlarge(gpu::Stream& stream, const film::Film& film) {
  if (scale_ == 1) return;
  if (!enlarge_) enlarge_ = gpu::Kernel(device_, compiler_, "overlay/enlarge.comp");
  resources_.set("FilmPicture", film.picture());
  resources_.set("Picture", picture_);
  stream.dispatch(enlarge_, resources_, EnlargePush{film.width(), film.height(), scale_},
                  gpu::groups_for(uint64_t{film.width()} * film.height() * scale_ * scale_, 64));
}

bool Sheet::can_trace() const { return uint64_t{frame_.width} * frame_.height <= Sight::k_most_points; }

bool Sheet::trace(transport::Wavefront& wavefront, const film::Film& film, uint32_t enabled,
                  const gpu::Defines& defines, const std::function<bool()>& cancel) {
  if (known_) return true;
  if (!sight_ || defines_ != defines) {
    sight_.emplace(device_, compiler_, defines);
    first_ = gpu::Kernel(device_, compiler_, "overlay/first.comp", defines);
    keep_ = gpu::Kernel(device_, compiler_, "overlay/first_keep.comp");
    defines_ = defines;
  }
  sight_->begin(frame_, 1);
  wavefront.set_frame(frame_, enabled);
  wavefront.bind_paths(resources_);
  resources_.set("Surfaces", sight_->surfaces());
  const auto keep = [&](const SeePush& push) {
    wavefront.stream().dispatch(keep_, resources_, push, gpu::groups_for(push.count, 64));
  };
  bool complete = true;
  wavefront.uncounted([&] {
    while (complete && !sight_->seen())
      complete = sight_->see(wavefront, "surfaces of overlays", keep, cancel, &first_);
  });
  known_ = complete;
  write_views(film);
  return complete;
}

void Sheet::bind(gpu::Resources& resources, bool of_film) const {
  resources.set("SheetBlock", of_film ? film_view_ : view_);
  resources.set("sheet_surfaces", known_ ? sight_->surfaces() : none_);
}

}  // namespace lucerna::overlay
