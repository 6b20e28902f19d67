// Every dataset of a log has something that goes red when it is false: each is corrupted in turn,
// and the audit must fail where this file says it does. A dataset that is not watched fails the
// test too.
#include <gtest/gtest.h>
#include <hdf5_hl.h>

#include <filesystem>
#include <limits>
#include <map>
#include <memory>

#include "core/log/seal.hpp"
#include "experiments/audit/audit.hpp"
#include "tests/support/stored_states.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::audit_corruption_test {

namespace fs = std::filesystem;

/// Datasets that the audit names where they are off.
constexpr const char* named_by_themselves[] = {"/contacts/frame",
                                               "/diagnostics/active",
                                               "/diagnostics/angular_momentum",
                                               "/diagnostics/elastic_energy",
                                               "/diagnostics/gravity_energy",
                                               "/diagnostics/head_drift",
                                               "/diagnostics/integrator_error",
                                               "/diagnostics/iterations",
                                               "/diagnostics/kinetic_energy",
                                               "/diagnostics/kkt_worst",
                                               "/diagnostics/limit_violation",
                                               "/diagnostics/momentum",
                                               "/diagnostics/penetration",
                                               "/diagnostics/qp_time",
                                               "/diagnostics/rows",
                                               "/diagnostics/skin_fold",
                                               "/diagnostics/solve",
                                               "/forces/active",
                                               "/forces/contact",
                                               "/forces/thigmotaxis",
                                               "/forces/tip",
                                               "/forces/wall",
                                               "/knot/agreement",
                                               "/knot/determinant",
                                               "/knot/head_end",
                                               "/knot/tail_end",
                                               "/knot/v2",
                                               "/mean/thigmotaxis/lambda",
                                               "/mean/thigmotaxis/slack",
                                               "/mean/thigmotaxis/speed",
                                               "/model/bending_limit",
                                               "/model/coordinate_name",
                                               "/model/dof_name",
                                               "/model/joint_name",
                                               "/model/length",
                                               "/model/limit_lower",
                                               "/model/limit_upper",
                                               "/model/mass",
                                               "/model/radius",
                                               "/model/arc",
                                               "/steps/time",
                                               "/pull/advantage_rows",
                                               "/pull/advantage_torque",
                                               "/pull/bearing",
                                               "/pull/force",
                                               "/pull/plate",
                                               "/pull/torque",
                                               "/steps/eq6",
                                               "/thigmotaxis/body_a",
                                               "/thigmotaxis/body_b",
                                               "/thigmotaxis/cap",
                                               "/thigmotaxis/command",
                                               "/thigmotaxis/lambda",
                                               "/thigmotaxis/slack",
                                               "/thigmotaxis/speed",
                                               "/trajectory/phase",
                                               "/trajectory/q_ref",
                                               "/trajectory/position",
                                               "/trajectory/step",
                                               "/trajectory/time",
                                               "/diagnostics/contacts"};

/// What the audit says of a dataset that is off by a hundredth in its largest entry: a part of a
/// failing finding's name or text, or of the refusal.
const std::map<std::string, std::string>& watchers() {
  static const std::map<std::string, std::string> by_path = [] {
    std::map<std::string, std::string> watch;
    for (const char* path : named_by_themselves) {
      watch[path] = path;
    }
    // By what is rebuilt from them, or summed with them.
    for (const char* name :
         {"impulse_drag", "impulse_outside", "integrator_momentum", "momentum_given_back"}) {
      watch[std::string("/diagnostics/") + name] = "momentum ledger";
    }
    for (const char* name : {"angular_impulse_drag", "angular_impulse_outside",
                             "integrator_angular_momentum", "angular_momentum_given_back"}) {
      watch[std::string("/diagnostics/") + name] = "angular momentum ledger";
    }
    for (const char* name : {"work_tip", "work_active", "work_thigmotaxis", "work_contact",
                             "work_limit", "work_head", "work_wall", "dissipated", "impact_loss"}) {
      watch[std::string("/diagnostics/") + name] = "energy ledger";
    }
    for (const char* name : {"inertia", "potential", "coriolis", "held", "given_back"}) {
      watch[std::string("/diagnostics/integrator_") + name] = "/diagnostics/integrator_error";
    }
    for (const char* name : {"thigmotaxis", "contact", "limit", "head", "wall", "active", "net"}) {
      watch[std::string("/mean/forces/") + name] = "balance of means";
    }
    for (const char* name : {"kkt_stationarity", "kkt_primal", "kkt_complementarity"}) {
      watch[std::string("/diagnostics/") + name] = "/steps/kkt";
    }
    watch["/checkpoints/data"] = "checkpoint";
    watch["/checkpoints/step"] = "checkpoint";
    watch["/checkpoints/end"] = "checkpoint";
    watch["/checkpoints/last"] = "checkpoint";
    watch["/diagnostics/wall_time"] = "/diagnostics/wall_time";
    watch["/forces/limit"] = "force balance";
    watch["/forces/head"] = "force balance";
    watch["/contacts/spline_a"] = "/forces/contact";
    watch["/contacts/spline_b"] = "/forces/contact";
    watch["/contacts/force"] = "/forces/contact";
    watch["/thigmotaxis/spline_a"] = "spline_a";
    watch["/thigmotaxis/spline_b"] = "spline_b";
    watch["/trajectory/q"] = "/trajectory/position";
    watch["/trajectory/qdot"] = "force balance";
    watch["/trajectory/qdot_next"] = "force balance";
    watch["/steps/kkt"] = "/diagnostics/kkt_worst";
    watch["/steps/left_out"] = "/steps/left_out";
    watch["/steps/penetration"] = "/diagnostics/penetration";
    watch["/steps/limit_violation"] = "/diagnostics/limit_violation";
    watch["/steps/head_drift"] = "/diagnostics/head_drift";
    watch["/steps/solve"] = "/diagnostics/solve";
    watch["/steps/rows"] = "/diagnostics/rows";
    watch["/steps/iterations"] = "/diagnostics/iterations";
    watch["/steps/qp_time"] = "/diagnostics/qp_time";
    watch["/steps/thigmotaxis_lambda"] = "/mean/thigmotaxis/lambda";
    watch["/steps/thigmotaxis_slack"] = "/mean/thigmotaxis/slack";
    watch["/steps/thigmotaxis_speed"] = "/mean/thigmotaxis/speed";
    return watch;
  }();
  return by_path;
}

/// A log of the whole Table 1 run, coarse enough to be audited some hundred times.
class AuditCorruption : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<TemporaryFolder>();
    file = *folder / "log.h5";
    const ResolvedScene resolved =
        stored_scene({"time.step=0.01", "time.frame_interval=0.2", "time.checkpoint_interval=6",
                      "knot.votes=5", "expect.slide_distance=8"});
    write_log(file, resolved);
  }
  static void TearDownTestSuite() { folder.reset(); }

  /// All that the audit objects to; empty for a good log.
  static std::string objections() { return audit_objections(file); }

  /// Where a dataset that labels axes has its place, of any of its names; any other as it is.
  static std::string own_path(const H5::H5File& h5, const std::string& path) {
    if (H5DSis_scale(h5.openDataSet(path).getId()) <= 0) return path;
    const std::string name = path.substr(path.rfind('/'));
    H5O_info_t here, there;
    H5Oget_info_by_name(h5.getId(), path.c_str(), &here, H5P_DEFAULT);
    for (const char* group : {"/model", "/trajectory", "/steps", "/contacts"}) {
      const std::string other = group + name;
      if (!h5.nameExists(other)) continue;
      H5Oget_info_by_name(h5.getId(), other.c_str(), &there, H5P_DEFAULT);
      if (here.addr == there.addr) return other;
    }
    return path;
  }

  static std::vector<std::string> datasets() {
    std::vector<std::string> paths;
    const H5::H5File h5(file.string(), H5F_ACC_RDONLY);
    const auto collect = [](hid_t, const char* name, const H5O_info_t* info, void* to) -> herr_t {
      if (info->type == H5O_TYPE_DATASET) {
        static_cast<std::vector<std::string>*>(to)->push_back(std::string("/") + name);
      }
      return 0;
    };
    H5Ovisit(h5.getId(), H5_INDEX_NAME, H5_ITER_INC, collect, &paths);
    // Labels of axes have their name in other groups too, of which one is met first.
    for (std::string& path : paths) path = own_path(h5, path);
    return paths;
  }

  /// Runs `judge` while `change` of the doubles of a dataset is in force.
  template <class Change, class Judge>
  static void while_changed(const std::string& path, Change change, Judge judge) {
    const auto before = rewrite<double>(file, path, H5::PredType::NATIVE_DOUBLE, change);
    judge();
    rewrite<double>(file, path, H5::PredType::NATIVE_DOUBLE,
                    [&before](std::vector<double>& values) { values = before; });
  }

  /// An entry in the middle; along the steps, of a step that begins at a frame.
  static std::size_t middle(std::size_t size) { return size / 40 * 20; }

  /// Runs `judge` while one entry of a dataset is false: the largest one by a hundredth, or, of
  /// whole numbers and where all are 0, one in the middle by 1.
  template <class Judge>
  static void while_corrupted(const std::string& path, Judge judge) {
    const H5T_class_t kind = [&path] {
      const H5::H5File h5(file.string(), H5F_ACC_RDONLY);
      return h5.openDataSet(path).getTypeClass();
    }();
    if (kind == H5T_FLOAT) {
      // Of the contacts followed, one that carries rows: while the knot slides.
      const bool followed = path.starts_with("/thigmotaxis/spline");
      // The head plate does next to no work here, of which a hundredth is rounding.
      const bool little = path == "/diagnostics/work_wall";
      const auto corrupt = [followed, little](std::vector<double>& values) {
        if (followed) {
          values[values.size() * 3 / 4] *= 1.01;
          return;
        }
        std::size_t largest = middle(values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
          const double now = std::isfinite(values[largest]) ? std::abs(values[largest]) : 0;
          largest = std::isfinite(values[i]) && std::abs(values[i]) > now ? i : largest;
        }
        // What is nothing but rounding, or nan, becomes 1.
        const bool scalable = std::isfinite(values[largest]) && std::abs(values[largest]) > 1e-9;
        values[largest] = scalable ? 1.01 * values[largest] : 1;
        if (little) values[largest] += 1;
      };
      while_changed(path, corrupt, judge);
    } else if (kind == H5T_INTEGER) {
      // Of a run as bytes, the high byte of an angle; contacts to search may be off by a little.
      const bool bytes = path == "/checkpoints/data" || path == "/checkpoints/last";
      const auto corrupt = [bytes](std::vector<std::int64_t>& values) {
        std::int64_t& value = values[bytes ? 266 : middle(values.size())];
        value = bytes ? value ^ 64 : value + 1;
      };
      const auto before = rewrite<std::int64_t>(file, path, H5::PredType::NATIVE_INT64, corrupt);
      judge();
      rewrite<std::int64_t>(file, path, H5::PredType::NATIVE_INT64,
                            [&before](auto& values) { values = before; });
    } else if (kind == H5T_ENUM) {
      const H5::DataType type =
          H5::H5File(file.string(), H5F_ACC_RDONLY).openDataSet(path).getDataType();
      const auto corrupt = [](std::vector<std::uint8_t>& values) {
        std::uint8_t& value = values[middle(values.size())];
        value = value == 1 ? 2 : 1;
      };
      const auto before = rewrite<std::uint8_t>(file, path, type, corrupt);
      judge();
      rewrite<std::uint8_t>(file, path, type, [&before](auto& values) { values = before; });
    } else {
      ADD_FAILURE() << path << " is of a kind that this test cannot corrupt";
    }
  }

  static std::unique_ptr<TemporaryFolder> folder;
  static fs::path file;
};

std::unique_ptr<TemporaryFolder> AuditCorruption::folder;
fs::path AuditCorruption::file;

TEST_F(AuditCorruption, AGoodLogIsGood) { EXPECT_EQ(objections(), ""); }

TEST_F(AuditCorruption, EachDatasetIsWatched) {
  for (const std::string& path : datasets()) {
    if (path.starts_with("/mjcf/")) {
      continue;  // text: AuditTest.RefusesAModelThatIsNotTheScenes
    }
    if (path.starts_with("/model/") && path.ends_with("_name")) {
      continue;  // text: NamesThatAreNotTheModels
    }
    if (path.starts_with("/enumerations/")) {
      continue;  // text: below
    }
    if (path == seal_path) {
      continue;  // text: check_changes_test.py
    }
    const auto watcher = watchers().find(path);
    ASSERT_NE(watcher, watchers().end()) << path << " is watched by nothing";
    const std::vector<std::string> only_wholly = {
        "/diagnostics/wall_time",  "/diagnostics/contacts",
        "/steps/qp_time",          "/diagnostics/kkt_stationarity",
        "/diagnostics/kkt_primal", "/diagnostics/kkt_complementarity"};
    if (std::ranges::find(only_wholly, path) != only_wholly.end()) {
      continue;  // of which one entry may be off by a little: SeesWholeDatasetsThatAreFalse
    }
    while_corrupted(path, [&] {
      EXPECT_NE(objections().find(watcher->second), std::string::npos)
          << path << " is false, and the audit says: " << objections();
    });
  }
  EXPECT_EQ(objections(), "") << "the test did not mend what it corrupted";
}

TEST_F(AuditCorruption, ExchangedColumnsAreSeen) {
  // In each pair both enter a ledger alike, which closes whichever is called which.
  const std::pair<const char*, const char*> pairs[] = {
      {"work_tip", "work_thigmotaxis"},
      {"work_tip", "work_contact"},
      {"work_active", "work_thigmotaxis"},
      {"work_active", "work_limit"},
      {"impulse_drag", "impulse_outside"},
      {"impulse_drag", "integrator_momentum"},
      {"impulse_outside", "integrator_momentum"},
      {"integrator_momentum", "momentum_given_back"},
      {"dissipated", "impact_loss"},
      {"angular_impulse_drag", "angular_impulse_outside"},
      {"angular_impulse_drag", "integrator_angular_momentum"},
      {"angular_impulse_outside", "integrator_angular_momentum"}};
  const auto exchange = [](const std::string& a, const std::string& b) {
    const H5::H5File h5(file.string(), H5F_ACC_RDWR);
    h5.move("/diagnostics/" + a, "/elsewhere");
    h5.move("/diagnostics/" + b, "/diagnostics/" + a);
    h5.move("/elsewhere", "/diagnostics/" + b);
  };
  for (const auto& [a, b] : pairs) {
    exchange(a, b);
    EXPECT_NE(objections(), "") << a << " and " << b;
    exchange(a, b);
  }
  EXPECT_EQ(objections(), "") << "the test did not mend what it exchanged";
}

TEST_F(AuditCorruption, EachDatasetMustBeThere) {
  for (const auto& [path, watcher] : watchers()) {
    {
      const H5::H5File h5(file.string(), H5F_ACC_RDWR);
      h5.move(path, "/elsewhere");
    }
    EXPECT_NE(objections().find(path), std::string::npos) << path << ": " << objections();
    const H5::H5File h5(file.string(), H5F_ACC_RDWR);
    h5.move("/elsewhere", path);
  }
}

TEST_F(AuditCorruption, SeesWholeDatasetsThatAreFalse) {
  const auto shifted = [](double by) {
    return [by](std::vector<double>& values) {
      for (double& value : values) value += by;
    };
  };
  const auto scaled = [](double by) {
    return [by](std::vector<double>& values) {
      for (double& value : values) value *= by;
    };
  };
  const auto all = [](double to) {
    return [to](std::vector<double>& values) { values.assign(values.size(), to); };
  };
  const auto frozen = [](std::size_t row) {
    return [row](std::vector<double>& values) {
      for (std::size_t i = row; i < values.size(); ++i) values[i] = values[i % row];
    };
  };
  const auto expect_named = [&](const std::string& path, const auto& change,
                                const std::string& by) {
    while_changed(path, change, [&] {
      EXPECT_NE(objections().find(by), std::string::npos) << path << ": " << objections();
    });
  };
  expect_named("/trajectory/position", shifted(100), "/trajectory/position");
  expect_named("/trajectory/position", frozen(300), "/trajectory/position");
  expect_named("/trajectory/time", scaled(1.0001), "/trajectory/time");
  expect_named("/knot/head_end", shifted(0.01), "/knot/head_end");
  for (const char* path :
       {"/steps/kkt", "/steps/penetration", "/steps/limit_violation", "/steps/head_drift",
        "/steps/qp_time", "/diagnostics/wall_time", "/diagnostics/kkt_stationarity",
        "/diagnostics/kkt_primal", "/diagnostics/kkt_complementarity"}) {
    expect_named(path, all(-1), path);
    expect_named(path, all(NAN), path);
  }
  expect_named("/diagnostics/contacts", shifted(1), "/diagnostics/contacts");
  // Columns of the first and of the last contact exchanged.
  const auto exchanged = [](std::vector<double>& values) {
    for (std::size_t i = 0; i + 3 < values.size(); i += 4) {
      std::swap(values[i], values[i + 2]);
      std::swap(values[i + 1], values[i + 3]);
    }
  };
  for (const char* path : {"/thigmotaxis/lambda", "/thigmotaxis/speed", "/thigmotaxis/command",
                           "/mean/thigmotaxis/lambda", "/mean/thigmotaxis/speed"}) {
    expect_named(path, exchanged, path);
  }
}

TEST_F(AuditCorruption, TheStateAtTheEndIsThatOfTheRunAndNoStep) {
  const auto off = [](std::vector<double>& values) {
    values.back() = std::isnan(values.back()) ? 1 : values.back() + 0.01;
  };
  for (const char* path :
       {"/trajectory/q", "/trajectory/qdot", "/trajectory/qdot_next", "/trajectory/q_ref",
        "/trajectory/position", "/forces/head", "/forces/tip", "/thigmotaxis/lambda",
        "/thigmotaxis/cap", "/mean/forces/limit", "/diagnostics/penetration",
        "/diagnostics/kkt_stationarity", "/diagnostics/kinetic_energy"}) {
    while_changed(path, off, [&] { EXPECT_NE(objections(), "") << path; });
  }
}

TEST_F(AuditCorruption, SeesBlocksOfMeansExchanged) {
  const auto exchange = [](const char* one, const char* other) {
    const H5::H5File h5(file.string(), H5F_ACC_RDWR);
    h5.move(one, "/elsewhere");
    h5.move(other, one);
    h5.move("/elsewhere", other);
  };
  const std::vector<std::string> blocks = {"thigmotaxis", "contact", "limit", "head", "wall"};
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    for (std::size_t j = i + 1; j < blocks.size(); ++j) {
      const std::string one = "/mean/forces/" + blocks[i];
      const std::string other = "/mean/forces/" + blocks[j];
      exchange(one.c_str(), other.c_str());
      EXPECT_NE(objections(), "") << one << " and " << other;
      exchange(one.c_str(), other.c_str());
    }
  }
}

TEST_F(AuditCorruption, NamesThatAreNotTheModels) {
  const auto exchange_names = [](const char* path) {
    const H5::H5File h5(file.string(), H5F_ACC_RDWR);
    const H5::DataSet set = h5.openDataSet(path);
    const H5::StrType text = set.getStrType();
    std::vector<char*> names(set.getSpace().getSimpleExtentNpoints());
    set.read(names.data(), text);
    std::swap(names[0], names[1]);
    set.write(names.data(), text);
    H5::DataSet::vlenReclaim(names.data(), text, set.getSpace());
  };
  for (const char* path :
       {"/model/joint_name", "/model/dof_name", "/model/coordinate_name", "/model/axis_name",
        "/model/plate_axis_name", "/model/contact_name", "/model/strand_name",
        "/enumerations/phase", "/enumerations/phase_description", "/enumerations/force",
        "/enumerations/loss", "/enumerations/knot", "/enumerations/knot_invariants"}) {
    exchange_names(path);
    EXPECT_NE(objections().find(path), std::string::npos) << objections();
    exchange_names(path);
  }
}

TEST_F(AuditCorruption, NumbersWithoutUnitOrDescription) {
  for (const char* path : {"/trajectory/q", "/checkpoints/data", "/checkpoints/last"}) {
    for (const char* word : {"unit", "description"}) {
      const auto rename = [&](const char* from, const char* to) {
        H5::H5File(file.string(), H5F_ACC_RDWR).openDataSet(path).renameAttr(from, to);
      };
      rename(word, "elsewhere");
      const std::string found = objections();
      EXPECT_NE(found.find(std::string(word) + " of " + path), std::string::npos) << found;
      rename("elsewhere", word);
    }
  }
}

}  // namespace hagfish::audit_corruption_test
