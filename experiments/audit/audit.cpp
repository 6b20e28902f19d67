#include "experiments/audit/audit.hpp"

#include "experiments/audit/audit_parts.hpp"
#include "experiments/judge/replay.hpp"

namespace hagfish {
namespace {

Finding status(const LogContents& log) {
  const std::string text = log.h5.root_text("status");
  return {"status", text == "complete", text, text, "complete", ""};
}

void append(std::vector<Finding>& findings, const std::vector<Finding>& more) {
  findings.insert(findings.end(), more.begin(), more.end());
}

/// Whether this program's steps do what they say.
class StepAudits {
 public:
  explicit StepAudits(const LogContents& log)
      : forces_(log), flesh_(log), activations_(log), forward_inverse_(log) {}

  void see(const AuditedFrame& frame) {
    forces_.see(frame);
    flesh_.see(frame);
    activations_.see(frame);
    if (frame.begins_step) forward_inverse_.see(frame);
  }

  std::vector<Finding> findings() const {
    std::vector<Finding> findings = forces_.findings();
    append(findings, flesh_.findings());
    append(findings, activations_.findings());
    findings.push_back(forward_inverse_.finding());
    return findings;
  }

 private:
  ForceAudit forces_;
  FleshAudit flesh_;
  ActivationAudit activations_;
  ForwardInverseAudit forward_inverse_;
};

}  // namespace

std::vector<Finding> audit(const std::string& file) { return audit(LogContents(file)); }

std::vector<Finding> audit(const LogContents& log) {
  const bool of_another = log.h5.has_root_attribute("simulator");
  Judge judge = judged_log(log);
  FrameAudit frames(log);
  StepAudits steps(log);
  for (Eigen::Index f = 0; f < log.q.rows(); ++f) {
    const AuditedFrame frame(log, f);
    frames.see(frame);
    if (!of_another) steps.see(frame);
    // As the frames are, whatever the log says of them.
    judge.see(Worst{frame.observation.penetration, frame.observation.limit_violation, 0, 0});
  }
  std::vector<Finding> findings{status(log)};
  append(findings, of_another ? judge.of_motion() : judge.findings());
  append(findings, frames.findings());
  if (!of_another) append(findings, steps.findings());
  return findings;
}

}  // namespace hagfish
