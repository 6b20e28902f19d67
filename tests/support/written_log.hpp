// Logs as `hagfish run` writes them, to be audited, and changes of their numbers.
#pragma once

#include <H5Cpp.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/input/files/scene_reader.hpp"
#include "core/run/simulation.hpp"

namespace hagfish {

/// Runs `scene` on from `sim` to its end, but for `most_steps` at most, and logs it in `file`. Each
/// step is said to have taken 0.1 ms.
void write_log(const std::filesystem::path& file, const ResolvedScene& scene, const Model& model,
               Simulation sim, int most_steps);

/// Logs the whole run of `scene`, by the active-set method, in `file`.
void write_log(const std::filesystem::path& file, const ResolvedScene& scene);

/// What the audit objects to in `file`, a line each, or why it refuses it. Empty for a good log.
std::string audit_objections(const std::filesystem::path& file);
/// The same while the log claims to be of `scene`.
std::string audit_objections_as(const std::filesystem::path& file, const ResolvedScene& scene);

/// Writes `text` as the scene of a log; returns what that was.
std::string write_scene(const std::filesystem::path& file, const std::string& text);

/// Lets `change` have the values of a dataset, written as `type`; returns what they were.
template <class T, class Change>
std::vector<T> rewrite(const std::filesystem::path& file, const std::string& path,
                       const H5::DataType& type, Change change) {
  const H5::H5File h5(file.string(), H5F_ACC_RDWR);
  const H5::DataSet set = h5.openDataSet(path);
  std::vector<T> values(set.getSpace().getSimpleExtentNpoints());
  set.read(values.data(), type);
  const std::vector<T> before = values;
  change(values);
  set.write(values.data(), type);
  return before;
}

/// What the audit objects to while `change` has had the values of a dataset, written as `type`.
template <class T, class Change>
std::string objections_while(const std::filesystem::path& file, const std::string& path,
                             const H5::DataType& type, Change change) {
  const std::vector<T> before = rewrite<T>(file, path, type, change);
  const std::string text = audit_objections(file);
  rewrite<T>(file, path, type, [&](std::vector<T>& values) { values = before; });
  return text;
}
/// The same of a dataset of numbers with fractions.
template <class Change>
std::string objections_while(const std::filesystem::path& file, const std::string& path,
                             Change change) {
  return objections_while<double>(file, path, H5::PredType::NATIVE_DOUBLE, change);
}

}  // namespace hagfish
