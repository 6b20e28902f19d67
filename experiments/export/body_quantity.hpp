// What the body can be coloured by: one number at each of some stations along it, in every frame.
#pragma once

#include <string>
#include <vector>

#include "core/log/reading/log_contents.hpp"

namespace hagfish {

struct BodyQuantity {
  std::string name, label, unit;
  std::vector<double> arc;  ///< places of the stations, rising, cm from the head
  Hdf5Reader::Rows values;  ///< frames x stations, not negative
};

/// thigmotaxis, thigmotaxis-twist, active, activation, curvature, twist, contact.
std::vector<std::string> body_quantity_names();

/// Torques are means since the frame before, 0 at the first frame: of a bend the size of both axes
/// together. The activation is the largest of a bending joint's muscles, of logs that have them.
/// Curvature and twist are a joint's turn over the length of body that it stands for. The contact
/// force, of the step at the frame, is spread over half a centimetre of body to be seen. Throws
/// std::invalid_argument for another name, FileError where a dataset is missing.
BodyQuantity body_quantity(const LogContents& log, const std::string& name);

/// Whether the log has what the quantity is made of.
bool has_quantity(const LogContents& log, const std::string& name);

/// The value that one in a hundred of those above 0 exceeds; 0 where there are none.
double colour_scale(const BodyQuantity& quantity);

}  // namespace hagfish
