#include "core/log/log_frame.hpp"

#include <cmath>
#include <string>

namespace hagfish {
namespace {

// Some tens of a frame; a chunk is read and written as one.
constexpr hsize_t chunk_rows = 1024;

}  // namespace

LogTable<BearingContact> contact_table(const Scene& scene, LogLevel level) {
  LogTable<BearingContact> t({level, contact_frame_labels, chunk_rows, level != LogLevel::full});
  t.count("/contacts/frame", "index along the frames of each contact with a force",
          [](const BearingContact& c) { return c.frame; });
  t.number("/contacts/spline_a",
           {"1",
            "spline parameter on the strand nearer the head, segment + t; of the head plate, or "
            "another plane, the body"},
           [](const BearingContact& c) { return c.row.points().a.parameter; });
  t.number("/contacts/spline_b",
           {"1",
            "spline parameter on the strand nearer the tail; nan where it is the head plate, or "
            "another obstacle"},
           [](const BearingContact& c) {
             return c.row.kind == RowKind::obstacle ? NAN : c.row.points().b.parameter;
           });
  t.number("/contacts/force",
           {"dyn", "multiplier over h of the step at the frame, along the normal"},
           [](const BearingContact& c) { return c.force; });
  if (!scene.obstacles.empty()) {
    t.count("/contacts/obstacle", "index in /model/obstacle_name; -1 where it is the body itself",
            [](const BearingContact& c) { return c.row.obstacle; });
    t.number(
        "/contacts/spline_obstacle",
        {"1",
         "spline parameter on the strand that is an obstacle, its segment + t; nan where it is "
         "a plane or the body itself"},
        [](const BearingContact& c) {
          return c.row.kind == RowKind::obstacle ? c.row.points().b.parameter : NAN;
        });
  }
  return t;
}

LogTable<FrameRow> row_table(LogLevel level) {
  LogTable<FrameRow> t({level, row_frame_labels, chunk_rows, level != LogLevel::full});
  const std::string which = " of each row of Eq. 6 at a frame";
  t.count("/eq6/frame", "index along the frames" + which,
          [](const FrameRow& r) { return r.frame; });
  t.count("/eq6/end", "0 the knot's first contact, 1 its last one, 2 neither",
          [](const FrameRow& r) { return static_cast<int>(r.row.end); });
  t.count("/eq6/along", "0 along t_a, 1 along t_b",
          [](const FrameRow& r) { return r.row.along_a ? 0 : 1; });
  t.count("/eq6/towards", "the knot is to go: 1 to the head; -1 to the tail, both tangents turn",
          [](const FrameRow& r) { return r.row.towards == BodyEnd::head ? 1 : -1; });
  const auto number = [&t](const char* name, const char* unit, const std::string& description,
                           double ThigmotaxisRow::*member) {
    t.number(std::string("/eq6/") + name, {unit, description},
             [member](const FrameRow& r) { return r.row.*member; });
  };
  number("spline_a", "1", "spline parameter on the strand nearer the head, segment + t",
         &ThigmotaxisRow::spline_a);
  number("spline_b", "1", "spline parameter on the strand nearer the tail",
         &ThigmotaxisRow::spline_b);
  number("command", "cm/s", "right side" + which, &ThigmotaxisRow::command);
  number("cap", "dyn", "largest multiplier over h" + which, &ThigmotaxisRow::cap);
  number("lambda", "dyn", "multiplier over h" + which, &ThigmotaxisRow::lambda);
  number("speed", "cm/s", "left side" + which, &ThigmotaxisRow::speed);
  number("slack", "cm/s", "shortfall of the command" + which, &ThigmotaxisRow::slack);
  return t;
}

}  // namespace hagfish
