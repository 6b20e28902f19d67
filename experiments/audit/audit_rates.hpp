// The part of an audit that holds running totals to the forces that make them. A ledger closes
// whichever of its columns is called which; a total that takes another one's name shows here.
#pragma once

#include <string>
#include <vector>

#include "experiments/audit/audited_frame.hpp"
#include "experiments/audit/expectations.hpp"
#include "experiments/audit/rebuilt.hpp"

namespace hagfish {

class RateAudit {
 public:
  /// The log is referred to.
  explicit RateAudit(const LogContents& log);
  /// Frames in their order.
  void see(const AuditedFrame& frame);
  std::vector<Finding> findings() const;
  /// Of the frames seen.
  const Passed& passed() const { return passed_; }

 private:
  /// A column of /diagnostics, and how far its growth is from what forces make of it.
  struct Growth {
    std::string name;
    double (Passed::*through)() const;  ///< whose rounding it may have
    Hdf5Reader::Rows total;             ///< frames x 1 or 3
    double off = 0, grown = 0;
    /// `passed`: the sum of the sizes of what `wanted` is the sum of, which may cancel.
    void compare(Eigen::Index frame, const Eigen::VectorXd& wanted, double passed = 0);
  };
  void see_outside(const AuditedFrame& frame, const Eigen::Vector3d& centre, double elapsed);

  const LogContents& log_;
  Hdf5Reader::Rows position_, tip_, thigmotaxis_, active_, head_, wall_, outside_;
  std::vector<Growth> growths_;
  Passed passed_;
  Rebuilt rebuilt_;
};

}  // namespace hagfish
