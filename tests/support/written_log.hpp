// Logs as `hagfish run` writes them, to be audited, and changes of their numbers.
#pragma once

#include <H5Cpp.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "tests/support/scene_run.hpp"

namespace hagfish {

/// Takes `run` to its end, but for `most_steps` at most, and logs it in `file`. Each step is said
/// to have taken 0.1 ms.
void write_log(const std::filesystem::path& file, SceneRun run,
               int most_steps = std::numeric_limits<int>::max());

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

/// For expect_watched: changes every number of a dataset; or one, from a third of it on the first
/// that `change` changes.
template <class Change>
auto every(Change change) {
  return [=](auto& values) { std::ranges::transform(values, values.begin(), change); };
}
template <class Change>
auto one(Change change) {
  return [=](auto& values) {
    const auto at = std::find_if(values.begin() + values.size() / 3, values.end(),
                                 [&](auto v) { return std::abs(change(v) - v) > 0; });
    ASSERT_NE(at, values.end());
    *at = change(*at);
  };
}

/// EXPECTs the audit to object by each of `watchers` while `change` has had a dataset's numbers.
template <class T = double, class Change>
void expect_watched(const std::filesystem::path& file, const std::string& path, Change change,
                    const std::vector<std::string>& watchers) {
  const H5::PredType& type =
      std::is_same_v<T, double> ? H5::PredType::NATIVE_DOUBLE : H5::PredType::NATIVE_INT64;
  const std::vector<T> before = rewrite<T>(file, path, type, change);
  const std::string text = audit_objections(file);
  rewrite<T>(file, path, type, [&](std::vector<T>& values) { values = before; });
  for (const std::string& watcher : watchers) {
    EXPECT_NE(text.find(watcher), std::string::npos) << path << ": " << text;
  }
}

}  // namespace hagfish
