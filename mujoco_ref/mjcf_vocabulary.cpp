#include "mujoco_ref/mjcf_vocabulary.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "mujoco_ref/mjcf.hpp"

namespace hagfish {
namespace {

// The largest model of a scene, 400 bodies, has 601 hinges, and 2600 rows; MuJoCo takes memory by
// the square of the rows.
constexpr int most_bodies = 400;
constexpr int most_joints = 3 * most_bodies;
constexpr int most_geoms = 20000;  // of bodies and of strands, which scene_reader.cpp bounds
constexpr int most_sites = 4 * 8 * most_bodies;  // at their definition and in tendons
constexpr int most_rows = 5000;
constexpr std::size_t largest_text = std::size_t{1} << 24;  // of one file, bytes

const std::map<std::string_view, std::set<std::string_view>>& vocabulary() {
  static const std::map<std::string_view, std::set<std::string_view>> attributes = {
      {"mujoco", {"model"}},
      {"mujocoinclude", {}},
      {"compiler", {"angle", "inertiafromgeom"}},
      {"option", {"timestep", "gravity"}},
      {"size", {"nconmax", "njmax"}},
      {"default", {}},
      {"worldbody", {}},
      {"include", {"file"}},
      {"contact", {}},
      {"exclude", {"body1", "body2"}},
      {"body", {"name", "pos"}},
      {"freejoint", {"name"}},
      {"joint", {"name", "type", "axis", "limited", "range", "stiffness", "springref", "damping"}},
      {"site", {"name", "pos", "site"}},
      {"tendon", {}},
      {"spatial", {"name"}},
      {"pulley", {"divisor"}},
      {"actuator", {}},
      {"general", {"name", "tendon", "ctrllimited", "ctrlrange", "gainprm"}},
      {"inertial", {"pos", "mass", "diaginertia"}},
      {"geom", {"type", "condim", "fromto", "size", "pos", "zaxis"}}};
  return attributes;
}

class VocabularyCheck : public tinyxml2::XMLVisitor {
 public:
  explicit VocabularyCheck(const std::map<std::string, std::string>& files) : files_(files) {}

  void file(const std::string& name, const std::string& text) {
    file_ = name;
    if (text.size() > largest_text) refuse("is larger than 16 MiB");
    tinyxml2::XMLDocument document;
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
      refuse(fmt::format("XML parse error at line {}: {}", document.ErrorLineNum(),
                         tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID())));
    }
    document.Accept(this);
  }

  bool VisitEnter(const tinyxml2::XMLElement& element,
                  const tinyxml2::XMLAttribute* first) override {
    const std::string_view name = element.Name();
    const auto known = vocabulary().find(name);
    if (known == vocabulary().end()) {
      refuse(fmt::format("<{}> at line {} is in no model of this program", name,
                         element.GetLineNum()));
    }
    for (const tinyxml2::XMLAttribute* a = first; a != nullptr; a = a->Next()) {
      if (!known->second.contains(a->Name())) {
        refuse(fmt::format("{} of <{}> at line {} is in no model of this program", a->Name(), name,
                           element.GetLineNum()));
      }
    }
    if (name == "include") include(element.Attribute("file"));
    if (name == "size") size(element);
    count(name == "body", bodies_, most_bodies, "bodies");
    count(name == "site" || name == "pulley", sites_, most_sites, "sites and pulleys");
    count(name == "joint", joints_, most_joints, "joints");
    count(name == "geom", geoms_, most_geoms, "geoms");
    return true;
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw std::runtime_error(file_ + ": " + why);
  }
  void include(const char* name) {
    if (name == nullptr || !files_.contains(name)) {
      refuse(fmt::format("includes {}, which is not one of its files", name ? name : "nothing"));
    }
    if (name == std::string_view(mjcf_root_file) || !included_.insert(name).second) {
      refuse(fmt::format("includes {} once more", name));
    }
  }
  void size(const tinyxml2::XMLElement& element) const {
    for (const char* name : {"nconmax", "njmax"}) {
      int value = 0;
      const tinyxml2::XMLError read = element.QueryIntAttribute(name, &value);
      if (read != tinyxml2::XML_NO_ATTRIBUTE &&
          (read != tinyxml2::XML_SUCCESS || value < 0 || value > most_rows)) {
        refuse(fmt::format("{} must be a whole number from 0 to {}", name, most_rows));
      }
    }
  }
  void count(bool one_more, int& so_far, int most, const char* what) const {
    so_far += one_more ? 1 : 0;
    if (so_far > most) refuse(fmt::format("more than {} {}", most, what));
  }

  const std::map<std::string, std::string>& files_;
  std::string file_;
  std::set<std::string> included_;
  int bodies_ = 0, joints_ = 0, geoms_ = 0, sites_ = 0;
};

}  // namespace

void check_vocabulary(const std::map<std::string, std::string>& files) {
  VocabularyCheck check(files);
  for (const auto& [name, text] : files) check.file(name, text);
}

}  // namespace hagfish
