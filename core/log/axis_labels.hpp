// Paths of the datasets that label the axes of others (dimension scales): in /model, and along the
// rows of each table.
#pragma once

namespace hagfish {

inline constexpr const char* joint_labels = "/model/joint_name";
inline constexpr const char* dof_labels = "/model/dof_name";
inline constexpr const char* muscle_labels = "/model/muscle_name";
inline constexpr const char* coordinate_labels = "/model/coordinate_name";
inline constexpr const char* body_labels = "/model/arc";
inline constexpr const char* axis_labels = "/model/axis_name";
inline constexpr const char* plate_labels = "/model/plate_axis_name";
inline constexpr const char* contact_labels = "/model/contact_name";
inline constexpr const char* strand_labels = "/model/strand_name";
inline constexpr const char* frame_labels = "/trajectory/time";
inline constexpr const char* step_labels = "/steps/time";
inline constexpr const char* contact_frame_labels = "/contacts/frame";
inline constexpr const char* row_frame_labels = "/eq6/frame";

}  // namespace hagfish
