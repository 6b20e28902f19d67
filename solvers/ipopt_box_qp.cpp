#include "solvers/ipopt_box_qp.hpp"

#include <algorithm>
#include <cmath>
#include <coin/IpIpoptApplication.hpp>
#include <coin/IpSolveStatistics.hpp>
#include <coin/IpTNLP.hpp>
#include <limits>
#include <stdexcept>

#include "solvers/crossover.hpp"
#include "solvers/free_rows.hpp"

namespace hagfish {
namespace {

using Ipopt::Index;
using Ipopt::Number;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// min ½ y' Q y - c' y, l <= y <= u, with Q of unit diagonal: lower triangle given dense.
class ScaledProblem final : public Ipopt::TNLP {
 public:
  BoxQp qp;
  Eigen::VectorXd start, start_lower, start_upper;  ///< y and the multipliers of its bounds
  Eigen::VectorXd y;                                ///< Ipopt's last point
  Eigen::Array<bool, Eigen::Dynamic, 1> far_rhs;    ///< rows of which b̂ is taken for smaller
  Eigen::Array<bool, Eigen::Dynamic, 1> endless;    ///< rows without an upper bound
  double least_objective = 0;                       ///< below it the solve is stopped
  double regularisation = 0;                        ///< added to the diagonal of Q
  std::function<bool()> stop;                       ///< whether to end the solve
  bool stopped = false;                             ///< it did

  /// Takes over min ½ x' A x - b' x with x = t y, t = β / sqrt(A_ii): unit diagonal and |b̂| <= 1 in
  /// rows that push at 0, so that Ipopt's tolerances mean what IpoptSettings says. Bounds beyond
  /// `far` are taken for infinite and |b̂| beyond it for `far`: an answer says whether that was
  /// right. Returns t.
  Eigen::VectorXd set(const BoxQp& problem, const Eigen::VectorXd& x, double far) {
    const Eigen::VectorXd s = problem.A.diagonal().cwiseSqrt().cwiseInverse();
    const double beta = rhs_scale(problem, s.cwiseInverse());
    Eigen::VectorXd t = beta * s;
    qp = {s.asDiagonal() * problem.A * s.asDiagonal(),
          (s.cwiseProduct(problem.b) / beta).cwiseMax(-far).cwiseMin(far),
          problem.lower.cwiseQuotient(t), problem.upper.cwiseQuotient(t)};
    far_rhs = qp.b.cwiseAbs().array() >= far;
    endless = (qp.upper.array() == infinity);
    qp.lower = (qp.lower.array() < -far).select(-infinity, qp.lower);
    qp.upper = (qp.upper.array() > far).select(infinity, qp.upper);
    start = x.cwiseQuotient(t).cwiseMax(qp.lower).cwiseMin(qp.upper);
    y = Eigen::VectorXd::Zero(t.size());
    return t;
  }

  bool get_nlp_info(Index& n, Index& m, Index& nnz_jac_g, Index& nnz_h_lag,
                    IndexStyleEnum& index_style) override {
    n = static_cast<Index>(qp.b.size());
    m = 0;
    nnz_jac_g = 0;
    nnz_h_lag = n * (n + 1) / 2;
    index_style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* x_l, Number* x_u, Index /*m*/, Number* /*g_l*/,
                       Number* /*g_u*/) override {
    Eigen::Map<Eigen::VectorXd>(x_l, n) = qp.lower;
    Eigen::Map<Eigen::VectorXd>(x_u, n) = qp.upper;
    return true;
  }

  bool get_starting_point(Index n, bool /*init_x*/, Number* x, bool init_z, Number* z_L,
                          Number* z_U, Index /*m*/, bool /*init_lambda*/,
                          Number* /*lambda*/) override {
    Eigen::Map<Eigen::VectorXd>(x, n) = start;
    if (init_z) {
      Eigen::Map<Eigen::VectorXd>(z_L, n) = start_lower;
      Eigen::Map<Eigen::VectorXd>(z_U, n) = start_upper;
    }
    return true;
  }

  bool eval_f(Index n, const Number* x, bool /*new_x*/, Number& value) override {
    const Eigen::Map<const Eigen::VectorXd> v(x, n);
    value = 0.5 * v.dot(qp.A * v + regularisation * v) - qp.b.dot(v);
    return true;
  }

  bool eval_grad_f(Index n, const Number* x, bool /*new_x*/, Number* grad) override {
    const Eigen::Map<const Eigen::VectorXd> v(x, n);
    Eigen::Map<Eigen::VectorXd>(grad, n) = qp.A * v + regularisation * v - qp.b;
    return true;
  }

  bool eval_g(Index /*n*/, const Number* /*x*/, bool /*new_x*/, Index /*m*/,
              Number* /*g*/) override {
    return true;
  }

  bool eval_jac_g(Index /*n*/, const Number* /*x*/, bool /*new_x*/, Index /*m*/, Index /*nele_jac*/,
                  Index* /*iRow*/, Index* /*jCol*/, Number* /*values*/) override {
    return true;
  }

  bool eval_h(Index n, const Number* /*x*/, bool /*new_x*/, Number factor, Index /*m*/,
              const Number* /*lambda*/, bool /*new_lambda*/, Index /*nele*/, Index* row,
              Index* column, Number* values) override {
    Index k = 0;
    for (Index j = 0; j < n; ++j) {
      for (Index i = j; i < n; ++i, ++k) {
        if (values == nullptr) {
          row[k] = i;
          column[k] = j;
        } else {
          values[k] = factor * (qp.A(i, j) + (i == j ? regularisation : 0));
        }
      }
    }
    return true;
  }

  bool intermediate_callback(Ipopt::AlgorithmMode /*mode*/, Index /*iteration*/, Number objective,
                             Number /*inf_pr*/, Number /*inf_du*/, Number /*mu*/, Number /*d_norm*/,
                             Number /*regularization*/, Number /*alpha_du*/, Number /*alpha_pr*/,
                             Index /*trials*/, const Ipopt::IpoptData* /*data*/,
                             Ipopt::IpoptCalculatedQuantities* /*quantities*/) override {
    stopped = stop();
    return (objective >= least_objective || !endless.any()) && !stopped;
  }

  void finalize_solution(Ipopt::SolverReturn /*status*/, Index n, const Number* x,
                         const Number* /*z_L*/, const Number* /*z_U*/, Index /*m*/,
                         const Number* /*g*/, const Number* /*lambda*/, Number /*value*/,
                         const Ipopt::IpoptData* /*data*/,
                         Ipopt::IpoptCalculatedQuantities* /*quantities*/) override {
    y = Eigen::Map<const Eigen::VectorXd>(x, n);
  }
};

/// Puts y on the central path next to the start: y z = mu with y - z kept at y0 - w0, measured from
/// the bound it is nearer to. mu is the smaller, the better the start.
void centre_start(ScaledProblem& p, const IpoptSettings& settings) {
  double off = natural_residual(p.qp, p.start);
  if (!(off <= 1)) {  // worse than y = 0, where it is at most 1
    p.start.setZero();
    off = 1;
  }
  const double mu = std::max(settings.barrier_share * off, settings.least_barrier);
  const BoxQp& qp = p.qp;
  const Eigen::VectorXd w = qp.A * p.start - qp.b;
  p.start_lower.setZero(w.size());
  p.start_upper.setZero(w.size());
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    const double width = qp.upper[i] - qp.lower[i];
    if (std::isinf(qp.lower[i]) && std::isinf(qp.upper[i])) continue;
    const double above = p.start[i] - qp.lower[i] - w[i];
    const double below = qp.upper[i] - p.start[i] + w[i];
    const double nearer = std::min(above, below);
    const double root = std::hypot(nearer, 2 * std::sqrt(mu));
    // The root without cancellation.
    const double positive = nearer > 0 ? 0.5 * (nearer + root) : 2 * mu / (root - nearer);
    const double room = std::min(positive, 0.5 * width);
    p.start[i] = above <= below ? qp.lower[i] + room : qp.upper[i] - room;
    (above <= below ? p.start_lower : p.start_upper)[i] = mu / room;
    if (std::isfinite(width)) {
      (above <= below ? p.start_upper : p.start_lower)[i] = mu / (width - room);
    }
  }
}

bool anything_pushes(const BoxQp& qp) {
  for (Eigen::Index i = 0; i < qp.b.size(); ++i) {
    if (pushes_at_zero(qp, i)) return true;
  }
  return false;
}

/// Whether the objective falls below the least on the ray of y, as it does where rows contradict
/// each other. Rounding of y' Q y counts as cost. Only rows without an upper bound can make such a
/// ray.
bool falls_without_end(const ScaledProblem& problem, const Eigen::VectorXd& y) {
  const BoxQp& qp = problem.qp;
  const Eigen::VectorXd ray = problem.endless.select(y, 0);
  const double length = ray.lpNorm<1>();
  const double cost =
      std::max(ray.dot(qp.A * ray), std::numeric_limits<double>::epsilon() * length * length);
  const double gain = qp.b.dot(ray);
  return gain > 0 &&
         -gain * gain < 2 * cost * problem.least_objective;  // min over t of ½ t² cost - t gain
}

}  // namespace

struct IpoptBoxQp::Engine {
  IpoptSettings settings;
  /// Full predictor-corrector steps from a centred warm start: a third of the time, but one problem
  /// in some thousands makes them cycle. Ipopt's own safeguarded way from its own start for those.
  Ipopt::SmartPtr<Ipopt::IpoptApplication> fast, careful;
  Ipopt::SmartPtr<ScaledProblem> problem;

  /// One run of `ipopt` from `start` on the bounded part; sets x, status and message of `solution`
  /// and adds its iterations.
  void attempt(Ipopt::IpoptApplication& ipopt, const BoundedPart& part,
               const Eigen::VectorXd& start, const BoxQp& qp, double far, BoxQpSolution& solution);

  /// What pivoting makes of the point where Ipopt failed: the rows that contradict each other, or
  /// the solution, where the answer may be polished.
  void pivot(const BoxQp& qp, BoxQpSolution& solution);
};

namespace {

Ipopt::SmartPtr<Ipopt::IpoptApplication> make_application(const IpoptSettings& settings,
                                                          bool fast) {
  Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
  auto options = application->Options();
  options->SetIntegerValue("print_level", 0);
  options->SetStringValue("sb", "yes");
  options->SetStringValue("linear_solver", "mumps");
  options->SetIntegerValue("mumps_mem_percent", settings.mumps_extra_memory);
  options->SetStringValue("hessian_constant", "yes");
  options->SetNumericValue(
      "tol", fast && settings.polish ? settings.polished_tolerance : settings.tolerance);
  options->SetIntegerValue("acceptable_iter", 0);
  options->SetIntegerValue("max_iter", settings.iteration_limit);
  options->SetNumericValue("bound_relax_factor", 0);
  options->SetStringValue("nlp_scaling_method", "none");
  if (fast) {
    options->SetStringValue("mehrotra_algorithm", "yes");
    options->SetStringValue("fast_step_computation", "yes");
    // The start is centred by centre_start; Ipopt must not push it away from its bounds again.
    options->SetStringValue("warm_start_init_point", "yes");
    for (const char* push :
         {"warm_start_bound_push", "warm_start_bound_frac", "warm_start_mult_bound_push"}) {
      options->SetNumericValue(push, 1e-12);
    }
  }
  if (application->Initialize("") != Ipopt::Solve_Succeeded) {
    throw std::runtime_error("Ipopt did not accept its options");
  }
  return application;
}

}  // namespace

IpoptBoxQp::IpoptBoxQp(const IpoptSettings& settings) : engine_(std::make_unique<Engine>()) {
  engine_->settings = settings;
  engine_->fast = make_application(settings, true);
  engine_->careful = make_application(settings, false);
  engine_->problem = new ScaledProblem;
  engine_->problem->least_objective = -settings.infeasible_objective;
  engine_->problem->regularisation = settings.regularisation;
  engine_->problem->stop = [this] { return stopped(); };
}

IpoptBoxQp::~IpoptBoxQp() = default;

void IpoptBoxQp::solve(const BoxQp& qp, const Eigen::VectorXd& start, BoxQpSolution& solution) {
  check_box_qp(qp);
  if (start.size() != qp.b.size()) {
    throw std::invalid_argument("box QP: start differs in size from the problem");
  }
  const BoundedPart part(qp);
  solution.iterations = 0;
  solution.message.clear();
  solution.contradicting.clear();
  if (!part.consistent()) {
    solution.x = part.expand(Eigen::VectorXd::Zero(part.reduced().b.size()));
    solution.status = SolveStatus::infeasible;
    engine_->pivot(qp, solution);
    return;
  }
  const Eigen::VectorXd reduced = Eigen::VectorXd::Zero(part.reduced().b.size());
  if (!anything_pushes(part.reduced())) {  // then zero is the answer
    solution.x = part.expand(reduced);
    const bool solved = kkt_residuals(qp, solution.x).worst() <= engine_->settings.accepted;
    solution.status = solved ? SolveStatus::solved : SolveStatus::failed;
    if (!solved) solution.message = "zero force of the bounded rows does not solve the problem";
    return;
  }
  engine_->attempt(*engine_->fast, part, part.restrict_to_reduced(start), qp, engine_->settings.far,
                   solution);
  if (solution.status == SolveStatus::failed || solution.status == SolveStatus::iteration_limit) {
    engine_->attempt(*engine_->careful, part, reduced, qp, infinity, solution);
  }
  if (solution.status == SolveStatus::failed || solution.status == SolveStatus::infeasible) {
    engine_->pivot(qp, solution);
  }
}

void IpoptBoxQp::Engine::pivot(const BoxQp& qp, BoxQpSolution& solution) {
  ActiveSetPivoting pivoting([this] { return problem->stop(); });
  const ActiveSetPivoting::Ending ending = pivot_from(qp, solution.x, pivoting);
  if (ending == ActiveSetPivoting::Ending::contradiction) {
    solution.status = SolveStatus::infeasible;
    solution.contradicting = pivoting.contradicting();
  } else if (ending == ActiveSetPivoting::Ending::settled && settings.polish &&
             kkt_residuals(qp, pivoting.x()).worst() <= settings.accepted) {
    solution.x = pivoting.x();
    solution.status = SolveStatus::solved;
    solution.message.clear();
  }
}

void IpoptBoxQp::Engine::attempt(Ipopt::IpoptApplication& ipopt, const BoundedPart& part,
                                 const Eigen::VectorXd& start, const BoxQp& qp, double far,
                                 BoxQpSolution& solution) {
  const Eigen::VectorXd unit = problem->set(part.reduced(), start, far);
  centre_start(*problem, settings);
  problem->stopped = false;
  const Ipopt::ApplicationReturnStatus code = ipopt.OptimizeTNLP(Ipopt::GetRawPtr(problem));
  if (Ipopt::IsValid(ipopt.Statistics())) {
    solution.iterations += ipopt.Statistics()->IterationCount();
  }
  Eigen::VectorXd y = problem->y.cwiseMax(problem->qp.lower).cwiseMin(problem->qp.upper);
  y = problem->far_rhs.select(0, y);  // else a trace of the barrier stays, times a huge w
  // Only what is solved is polished: failures must show.
  if (settings.polish && code == Ipopt::Solve_Succeeded) y = crossover(problem->qp, y);
  solution.x = part.expand(
      unit.cwiseProduct(y).cwiseMax(part.reduced().lower).cwiseMin(part.reduced().upper));
  solution.message = "Ipopt return code " + std::to_string(static_cast<int>(code));
  if (problem->stopped) {
    solution.status = SolveStatus::stopped;
  } else if (kkt_residuals(qp, solution.x).worst() <= settings.accepted) {
    solution.status = SolveStatus::solved;
    solution.message.clear();
  } else if (falls_without_end(*problem, y)) {
    solution.status = SolveStatus::infeasible;
  } else {
    solution.status = code == Ipopt::Maximum_Iterations_Exceeded ? SolveStatus::iteration_limit
                                                                 : SolveStatus::failed;
  }
}

}  // namespace hagfish
