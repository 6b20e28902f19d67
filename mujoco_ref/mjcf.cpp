#include "mujoco_ref/mjcf.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>
#include <vector>

#include "core/contact/obstacles.hpp"

namespace hagfish {
namespace {

// The XML reader of MuJoCo 2.2 refuses elements nested deeper than 100, and a chain nests one body
// in another. The limit holds per file: includes are spliced into the tree after reading.
constexpr int bodies_per_file = 40;

// MuJoCo drops contacts beyond its own bound, 100 whatever the model. In a tight knot of 100 bodies
// 90 to 150 pairs touch (core/contact/contact.hpp), and a pair of capsules can have two contacts.
constexpr int contacts_per_body = 5;

std::ostringstream number_stream() {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(std::numeric_limits<double>::max_digits10);
  return out;
}

std::string body_name(int body) { return "b" + std::to_string(body); }

std::string bodies_file_name(int first_body) {
  return "hagfish_bodies_" + std::to_string(first_body) + ".xml";
}

void write_hinge(std::ostream& out, const Hinge& hinge, const std::string& name) {
  const Eigen::Vector3d axis = Eigen::Vector3d::Unit(static_cast<int>(hinge.axis));
  const bool limited = std::isfinite(hinge.lower) || std::isfinite(hinge.upper);
  out << "<joint name=\"" << name << "\" type=\"hinge\" axis=\"" << axis.transpose()
      << "\" limited=\"" << (limited ? "true" : "false") << "\" range=\"" << hinge.lower << ' '
      << hinge.upper << "\" stiffness=\"" << hinge.stiffness << "\" springref=\"0\" damping=\""
      << hinge.damping << "\"/>\n";
}

/// Lines of muscles begin and end at sites.
std::string site_name(const Muscle& muscle, std::size_t line, const char* end) {
  return muscle.name + '_' + std::to_string(line) + '_' + end;
}

void write_sites(std::ostream& out, const Model& model, int body) {
  for (const Muscle& muscle : model.muscles) {
    for (std::size_t k = 0; k < muscle.lines.size(); ++k) {
      const MuscleLine& line = muscle.lines[k];
      if (muscle.body - 1 == body) {
        out << "<site name=\"" << site_name(muscle, k, "head") << "\" pos=\""
            << line.head.transpose() << "\"/>\n";
      } else if (muscle.body == body) {
        out << "<site name=\"" << site_name(muscle, k, "tail") << "\" pos=\""
            << line.tail.transpose() << "\"/>\n";
      }
    }
  }
}

/// A tendon for each muscle, whose length is the sum of its lines', and an actuator on it that
/// pulls with F_max times its control, 0 to 1.
void write_muscles(std::ostream& out, const Model& model) {
  if (model.muscles.empty()) return;
  out << "<tendon>\n";
  for (const Muscle& muscle : model.muscles) {
    out << "<spatial name=\"" << muscle.name << "\">\n";
    for (std::size_t k = 0; k < muscle.lines.size(); ++k) {
      if (k > 0) out << "<pulley divisor=\"1\"/>\n";
      for (const char* end : {"head", "tail"}) {
        out << "<site site=\"" << site_name(muscle, k, end) << "\"/>\n";
      }
    }
    out << "</spatial>\n";
  }
  out << "</tendon>\n"
         "<actuator>\n";
  for (const Muscle& muscle : model.muscles) {
    out << "<general name=\"" << muscle.name << "\" tendon=\"" << muscle.name
        << "\" ctrllimited=\"true\" ctrlrange=\"0 1\" gainprm=\"" << -muscle.force << "\"/>\n";
  }
  out << "</actuator>\n";
}

/// Everything in the element of body `b` but the body that hangs on it, and not its end.
void open_body(std::ostream& out, const Model& model, int b, const JointName& names, Head head) {
  const Body& body = model.bodies[b];
  const double joint = b == 0 ? 0 : model.bodies[b - 1].length;
  out << "<body name=\"" << body_name(b) << "\" pos=\"" << joint << " 0 0\">\n";
  if (b == 0 && head == Head::free) {
    out << "<freejoint name=\"" << names.joint << "\"/>\n";
  } else if (b > 0) {
    for (int k = 0; k < body.dofs; ++k) {
      write_hinge(out, model.hinges[body.first_dof - root_dofs + k], names.dofs[k]);
    }
  }
  out << "<inertial pos=\"" << 0.5 * body.length << " 0 0\" mass=\"" << body.mass
      << "\" diaginertia=\"" << body.inertia.x() << ' ' << body.inertia.y() << ' '
      << body.inertia.z() << "\"/>\n";
  if (body.radius > 0) {
    out << "<geom fromto=\"0 0 0 " << body.length << " 0 0\" size=\"" << body.radius << "\"/>\n";
  }
  write_sites(out, model, b);
}

/// The bodies from `first` on, nested, as far as one file goes; the rest is included.
std::string bodies_file(const Model& model, const std::vector<JointName>& names, int first,
                        Head head) {
  std::ostringstream out = number_stream();
  const int end = std::min(first + bodies_per_file, model.body_count());
  out << "<mujocoinclude>\n";
  for (int b = first; b < end; ++b) open_body(out, model, b, names[b], head);
  if (end < model.body_count()) out << "<include file=\"" << bodies_file_name(end) << "\"/>\n";
  for (int b = first; b < end; ++b) out << "</body>\n";
  out << "</mujocoinclude>\n";
  return out.str();
}

void write_excludes(std::ostream& out, const Model& model, double least_arc) {
  std::vector<double> arc{0};  // of the bodies' front ends and the tail, cm
  for (const Body& body : model.bodies) arc.push_back(arc.back() + body.length);
  const ContactSettings contact{.least_arc = least_arc};
  for (int a = 0; a < model.body_count(); ++a) {
    for (int b = a + 1; b < model.body_count() && !contact.may_touch(arc[b] - arc[a + 1]); ++b) {
      out << "<exclude body1=\"" << body_name(a) << "\" body2=\"" << body_name(b) << "\"/>\n";
    }
  }
}

/// What the world holds that bodies touch.
void write_obstacles(std::ostream& out, const Model& model) {
  for (const Obstacle& obstacle : model.obstacles) {
    if (const Plane* plane = obstacle.plane()) {
      if (plane->neck > 0) continue;
      out << "<geom type=\"plane\" pos=\"" << plane->point.transpose() << "\" zaxis=\""
          << plane->normal.transpose() << "\" size=\"20 20 1\"/>\n";
      continue;
    }
    const Strand& strand = *obstacle.strand();
    if (strand.points.size() == 1) {
      out << "<geom type=\"sphere\" pos=\"" << strand.points[0].transpose() << "\" size=\""
          << strand.radius << "\"/>\n";
      continue;
    }
    const Eigen::Matrix3Xd curve = strand_curve(strand);
    for (Eigen::Index k = 0; k + 1 < curve.cols(); ++k) {
      out << "<geom fromto=\"" << curve.col(k).transpose() << ' ' << curve.col(k + 1).transpose()
          << "\" size=\"" << strand.radius << "\"/>\n";
    }
  }
}

std::string root_file(const Model& model, double least_arc, double h) {
  const int contacts = contacts_per_body * model.body_count();
  const int rows = contacts + model.hinge_count();  // each contact is one row
  std::ostringstream out = number_stream();
  out << "<!-- Units: cm, g, s, rad. -->\n"
         "<!-- The animal and its obstacles, without water drag, the head plate, and what a scene "
         "does to the "
         "animal or has it do: "
         "the tip's force, the active torques of its muscles (their stiffness towards a rest shape "
         "that moves is no joint stiffness of MuJoCo's), thigmotaxis. -->\n";
  if (!model.cones.empty()) {
    out << "<!-- Left out: the limit on the total angle of each bending joint (Y and Z together). "
           "MuJoCo limits hinges one by one. -->\n";
  }
  out << "<mujoco model=\"hagfish\">\n"
         "<compiler angle=\"radian\" inertiafromgeom=\"false\"/>\n"
      << "<option timestep=\"" << h << "\" gravity=\"" << model.gravity.x() << ' '
      << model.gravity.y() << ' ' << model.gravity.z() << "\"/>\n"
      << "<size nconmax=\"" << contacts << "\" njmax=\"" << rows << "\"/>\n"
      << "<default>\n"
         "<geom type=\"capsule\" condim=\"1\"/>\n"
         "</default>\n"
         "<worldbody>\n"
         "<include file=\""
      << bodies_file_name(0) << "\"/>\n";
  write_obstacles(out, model);
  out << "</worldbody>\n"
         "<contact>\n";
  write_excludes(out, model, least_arc);
  out << "</contact>\n";
  write_muscles(out, model);
  out << "</mujoco>\n";
  return out.str();
}

}  // namespace

std::map<std::string, std::string> mjcf_files(const Model& model, double least_arc, double h,
                                              Head head) {
  const std::vector<JointName> names = joint_names(model);
  std::map<std::string, std::string> files;
  files[mjcf_root_file] = root_file(model, least_arc, h);
  for (int first = 0; first < model.body_count(); first += bodies_per_file) {
    files[bodies_file_name(first)] = bodies_file(model, names, first, head);
  }
  return files;
}

std::string flat_mjcf(const std::map<std::string, std::string>& files) {
  std::string text = files.at(mjcf_root_file);
  const std::string before = "<include file=\"", after = "\"/>\n";
  for (std::size_t at = 0; (at = text.find(before, at)) != std::string::npos;) {
    const std::size_t name = at + before.size(), end = text.find(after, name);
    const std::string& bodies = files.at(text.substr(name, end - name));
    const std::size_t first = bodies.find('\n') + 1, last = bodies.rfind("</mujocoinclude>");
    text.replace(at, end + after.size() - at, bodies, first, last - first);
  }
  return text;
}

}  // namespace hagfish
