#include "experiments/mujoco/frame_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/control/controller.hpp"
#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "experiments/mujoco/obstacle_geoms.hpp"

namespace hagfish {
namespace {

constexpr int least_side = 16, largest_side = 8192;  // px

}  // namespace

PictureSize picture_size(const std::string& text, const std::string& option) {
  PictureSize size;
  const char* const end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width);
  const bool cross = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
  const auto height =
      cross ? std::from_chars(width.ptr + 1, end, size.height) : std::from_chars_result{end, {}};
  const auto within = [](int side) { return side >= least_side && side <= largest_side; };
  if (!cross || height.ec != std::errc() || height.ptr != end || !within(size.width) ||
      !within(size.height)) {
    throw_input_error(fmt::format("{} {}: must be WIDTHxHEIGHT, each {} to {} px", option,
                                  shortened(text), least_side, largest_side));
  }
  return size;
}

std::size_t frame_at(const LogContents& log, double time) {
  if (!(time >= log.time.front() && time <= log.time.back())) {
    throw InputError(fmt::format("{}: --time {:g}: the log runs from {:g} to {:g} s", log.h5.file(),
                                 time, log.time.front(), log.time.back()));
  }
  const auto after = std::lower_bound(log.time.begin(), log.time.end(), time);
  const auto frame = static_cast<std::size_t>(after - log.time.begin());
  return frame > 0 && time - log.time[frame - 1] < *after - time ? frame - 1 : frame;
}

FramePictures::FramePictures(const LogContents& log, double pitch, double yaw,
                             const std::string& quantity)
    : log_(log),
      view_(turned_view(pitch, yaw)),
      model_(skin_model(skin_rings(log.model), skin_sides, log.model.length())) {
  for (const auto& [name, angle] : {std::pair{"--pitch", pitch}, {"--yaw", yaw}}) {
    if (!(std::abs(angle) <= 360)) {
      throw InputError(fmt::format("{} {:g}: must be from -360 to 360 degrees", name, angle));
    }
  }
  if (!quantity.empty()) {
    quantity_ = body_quantity(log, quantity);
    scale_ = colour_scale(*quantity_);
    bar_ = ColourBar{colour_steps(), fmt::format("{}, {}", quantity_->label, quantity_->unit), "0",
                     scale_ > 0 ? fmt::format("{:.3g} or more", scale_) : "0 throughout"};
  }
}

Skin FramePictures::skin(std::size_t frame) const {
  const auto f = static_cast<Eigen::Index>(frame);
  Kinematics kin;
  update_positions(log_.model, log_.q.row(f), kin);
  Skin skin = skin_of(log_.model, log_.resolved.specimen, kin.centre);
  if (quantity_ && !quantity_->arc.empty()) {
    paint(log_.model, log_.resolved.specimen, quantity_->arc, quantity_->values.row(f), scale_,
          skin);
  }
  return skin;
}

std::vector<mjvGeom> FramePictures::obstacles(std::size_t frame, bool floors) const {
  std::vector<mjvGeom> geoms;
  if (log_.resolved.scene.wall.present) {
    geoms.push_back(plate_geom(log_.clamped(static_cast<Eigen::Index>(frame))));
  }
  for (const DrawnObstacle& obstacle :
       drawn_obstacles(log_.resolved.scene.obstacles, log_.model.length())) {
    const auto* square = std::get_if<DrawnSquare>(&obstacle);
    if (!floors && square != nullptr && square->floor) continue;
    std::ranges::copy(obstacle_geoms(obstacle, view_.toward()), std::back_inserter(geoms));
  }
  return geoms;
}

void FramePictures::add(std::size_t frame, Shown& shown) const {
  shown.add(view_, skin(frame));
  for (const mjvGeom& box : obstacles(frame, false)) shown.add(view_, box);
}

std::unique_ptr<OffscreenRenderer> FramePictures::renderer(PictureSize size,
                                                           const PictureQuality& quality) const {
  return std::make_unique<OffscreenRenderer>(*model_.model(), size.width, size.height, quality);
}

Image FramePictures::draw(OffscreenRenderer& renderer, std::size_t frame, const View& view,
                          const std::string& words) const {
  return renderer.render(obstacles(frame, true), view, skin(frame), words, bar_ ? &*bar_ : nullptr);
}

void FramePictures::fit(const Shown& shown, std::optional<PictureSize> size, View& view,
                        bool words) const {
  int room = bar_ || words ? bar_room : 0;
  if (size) {
    room = std::min(room, size->height / 3);  // small ones are for what they show
    hagfish::fit(shown, size->width, size->height - room, view);
  } else {
    hagfish::fit(shown, view);
  }
  add_room(room, view);
}

}  // namespace hagfish
