#include "experiments/view/view_page.hpp"

#include <algorithm>
#include <bit>
#include <cereal/external/base64.hpp>
#include <cmath>

#include "core/control/controller.hpp"
#include "core/input/input_text.hpp"
#include "core/knot/knot_words.hpp"
#include "experiments/export/body_quantity.hpp"
#include "experiments/export/frame_contacts.hpp"
#include "experiments/judge/replay.hpp"
#include "experiments/view/along_body.hpp"
#include "experiments/view/drawn_obstacles.hpp"

namespace hagfish {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "the page reads little-endian arrays");

template <class T>
std::string base64(const std::vector<T>& values) {
  if (values.empty()) return "";
  return cereal::base64::encode(
      static_cast<const unsigned char*>(static_cast<const void*>(values.data())),
      values.size() * sizeof(T));
}

/// Any range of numbers.
template <class Values>
Json floats(const Values& values) {
  std::vector<float> out;
  for (const double value : values) out.push_back(static_cast<float>(value));
  return {{"f4", base64(out)}};
}

Json quantised(const Hdf5Reader::Rows& rows) {
  constexpr double steps = 32767;
  constexpr std::int16_t none = -32768;
  double most = 0;
  for (const double value : rows.reshaped<Eigen::RowMajor>()) {
    if (std::isfinite(value)) most = std::max(most, std::abs(value));
  }
  const double scale = most / steps;
  std::vector<std::int16_t> out;
  for (const double value : rows.reshaped<Eigen::RowMajor>()) {
    out.push_back(!std::isfinite(value) ? none
                  : scale > 0           ? static_cast<std::int16_t>(std::lround(value / scale))
                                        : std::int16_t{0});
  }
  return {{"i2", base64(out)}, {"scale", scale}};
}

Json float_rows(const LogContents& log, const std::string& path) {
  return floats(log.h5.rows(path).reshaped<Eigen::RowMajor>());
}

/// The animal, constant through time.
Json animal(const LogContents& log) {
  Json json;
  const Model& model = log.model;
  std::vector<double> radius;
  for (const Body& body : model.bodies) radius.push_back(body.radius);
  json["length"] = model.length();
  json["station"] = log.resolved.specimen.station;
  json["radius"] = floats(radius);
  json["arc"] = floats(body_centres(model));
  return json;
}

/// The slide up to each frame: ways of head end and tail end, what taper asks of the latter, way of
/// the curvature, cm.
Json slide_so_far(const LogContents& log) {
  std::vector<double> values;
  const LogFrames frames(log);
  SlideWatch so_far(log.model);
  for (Eigen::Index f = 0; f < log.q.rows(); ++f) {
    const RunFrame frame = frames.at(f);
    so_far.see(frame.phase, frame.span, frame.q);
    const Slide slide = so_far.slide();
    values.insert(values.end(),
                  {slide.leading_way, slide.trailing_way, slide.taper_asks, slide.travel});
  }
  return floats(values);
}

/// Phases and knot types as places in lists of their names.
void add_stages(const LogContents& log, Json& json) {
  const std::vector<KnotInvariants> types = logged_knots(log);
  std::vector<std::string> knots;
  std::vector<std::uint8_t> phase, knot, clamped;
  for (std::size_t f = 0; f < log.time.size(); ++f) {
    phase.push_back(static_cast<std::uint8_t>(log.phase[f]));
    clamped.push_back(log.clamped(static_cast<Eigen::Index>(f)) ? 1 : 0);
    const std::string name = knot_words(types[f]);
    auto found = std::ranges::find(knots, name);
    // A log of no sense may have any number of types: one byte names the first 255.
    if (found == knots.end() && knots.size() < 255) found = knots.insert(found, name);
    knot.push_back(static_cast<std::uint8_t>(found - knots.begin()));
  }
  knots.emplace_back("another type");
  json["phases"] = names_by_value(phase_table);
  json["knots"] = knots;
  json["phase"] = {{"u1", base64(phase)}};
  json["knot"] = {{"u1", base64(knot)}};
  json["clamped"] = {{"u1", base64(clamped)}};
  json["head_end"] = floats(log.h5.doubles("/knot/head_end"));
  json["tail_end"] = floats(log.h5.doubles("/knot/tail_end"));
  json["slide"] = slide_so_far(log);
}

/// Contacts that bear; those of frame f are number first[f] to first[f + 1].
Json bearing_contacts(const LogContents& log) {
  const FrameContacts contacts(log);
  std::vector<std::uint32_t> first{0};
  std::vector<double> values;
  for (std::size_t f = 0; f < log.time.size(); ++f) {
    std::uint32_t count = first.back();
    for (const FrameContact& c : contacts.at({log, static_cast<Eigen::Index>(f)})) {
      if (c.force <= 0) continue;
      values.insert(values.end(), {c.point.x(), c.point.y(), c.point.z(), c.normal.x(),
                                   c.normal.y(), c.normal.z(), c.force, c.arc_a, c.arc_b});
      ++count;
    }
    first.push_back(count);
  }
  return {{"first", {{"u4", base64(first)}}}, {"values", floats(values)}};
}

}  // namespace

Json view_data(const LogContents& log, const std::string& name) {
  Json json{{"name", printable(name)},
            {"title", printable(log.resolved.scene.title)},
            {"specimen", printable(log.resolved.specimen.name)},
            {"status", printable(log.h5.root_text("status"))},
            {"plate", log.resolved.scene.wall.present},
            {"obstacles",
             Json::parse(drawn_obstacles_json(log.resolved.scene.obstacles, log.model.length()))},
            {"animal", animal(log)},
            {"time", floats(log.time)}};
  add_stages(log, json);
  json["position"] = float_rows(log, "/trajectory/position");
  for (const std::string& quantity : body_quantity_names()) {
    if (!has_quantity(log, quantity)) continue;
    const BodyQuantity along = body_quantity(log, quantity);
    // Torques of muscles, or any, that there are none of are not offered.
    if (const double scale = colour_scale(along); scale > 0) {
      json["quantities"][quantity] = {{"label", along.label},
                                      {"unit", along.unit},
                                      {"scale", scale},
                                      {"arc", along.arc},
                                      {"values", quantised(along.values)}};
    }
  }
  json["contacts"] = bearing_contacts(log);
  json["tip"] = float_rows(log, "/forces/tip");
  json["head"] = floats(
      log.h5.rows("/mean/forces/head").leftCols<root_dofs>().eval().reshaped<Eigen::RowMajor>());
  json["plate_force"] = floats(log.h5.rows("/mean/forces/wall").col(0));
  for (const char* row : {"speed", "slack", "lambda"}) {
    json["eq6"][row] = float_rows(log, std::string("/mean/thigmotaxis/") + row);
  }
  json["eq6"]["command"] = float_rows(log, "/thigmotaxis/command");
  for (const char* term : {"kinetic_energy", "elastic_energy", "work_tip", "work_active",
                           "work_thigmotaxis", "dissipated"}) {
    json["energy"][term] = floats(log.h5.doubles(std::string("/diagnostics/") + term));
  }
  return json;
}

}  // namespace hagfish
