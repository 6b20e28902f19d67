#include "core/input/csv/program_table.hpp"

#include <string>
#include <utility>

namespace hagfish {

CurvatureProgram resolve_table(const TableReader& root, const ProgramTable& table) {
  const auto rising = [&](const std::string& key, const std::vector<double>& values) {
    if (values.empty()) root.fail("script.curvature", key + " is missing");
    for (std::size_t i = 1; i < values.size(); ++i) {
      if (values[i] <= values[i - 1]) {
        root.fail_element("script.curvature." + key, i,
                          "must rise; number " + std::to_string(i + 1) + " does not");
      }
    }
  };
  rising("times", table.times);
  rising("stations", table.stations);
  if (table.times[0] != 0 || table.times.size() < 2) {
    root.fail("script.curvature.times", "must have two times or more, the first 0");
  }
  const auto stations = static_cast<Eigen::Index>(table.stations.size());
  CurvatureProgram program{table.times, table.stations, {}, {}};
  program.value.assign(table.times.size(), Eigen::Matrix3Xd::Zero(3, stations));
  const std::pair<const char*, const std::vector<double>&> rows[] = {
      {"bend_y", table.bend_y}, {"bend_z", table.bend_z}, {"twist", table.twist}};
  for (int i = 0; i < 3; ++i) {
    const auto& [key, values] = rows[i];
    if (values.size() != table.times.size() * table.stations.size()) {
      root.fail("script.curvature." + std::string(key),
                "must have times x stations values, " +
                    std::to_string(table.times.size() * table.stations.size()));
    }
    for (std::size_t k = 0; k < values.size(); ++k) {
      program.value[k / table.stations.size()](
          i, static_cast<Eigen::Index>(k % table.stations.size())) = values[k];
    }
  }
  return program;
}

ProgramTable program_table(const CurvatureProgram& program) {
  ProgramTable table{program.time, program.station, {}, {}, {}};
  for (const Eigen::Matrix3Xd& value : program.value) {
    std::vector<double>* rows[] = {&table.bend_y, &table.bend_z, &table.twist};
    for (int i = 0; i < 3; ++i) {
      rows[i]->insert(rows[i]->end(), value.row(i).begin(), value.row(i).end());
    }
  }
  return table;
}

}  // namespace hagfish
