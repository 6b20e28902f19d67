#include "solvers/ipopt_box_qp.hpp"

#include <coin/IpIpoptApplication.hpp>
#include <coin/IpSolveStatistics.hpp>
#include <coin/IpTNLP.hpp>
#include <stdexcept>

namespace hagfish {
namespace {

using Ipopt::Index;
using Ipopt::Number;

/// min ½ y' Q y - c' y, l <= y <= u, with Q of unit diagonal: lower triangle given dense.
class ScaledProblem final : public Ipopt::TNLP {
 public:
  Eigen::MatrixXd Q;
  Eigen::VectorXd c, lower, upper, start, y;
  Eigen::VectorXd bound_multiplier_lower, bound_multiplier_upper;

  bool get_nlp_info(Index& n, Index& m, Index& nnz_jac_g, Index& nnz_h_lag,
                    IndexStyleEnum& index_style) override {
    n = static_cast<Index>(c.size());
    m = 0;
    nnz_jac_g = 0;
    nnz_h_lag = n * (n + 1) / 2;
    index_style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* x_l, Number* x_u, Index /*m*/, Number* /*g_l*/,
                       Number* /*g_u*/) override {
    Eigen::Map<Eigen::VectorXd>(x_l, n) = lower;
    Eigen::Map<Eigen::VectorXd>(x_u, n) = upper;
    return true;
  }

  bool get_starting_point(Index n, bool /*init_x*/, Number* x, bool init_z, Number* z_L,
                          Number* z_U, Index /*m*/, bool /*init_lambda*/,
                          Number* /*lambda*/) override {
    Eigen::Map<Eigen::VectorXd>(x, n) = start;
    if (init_z) {
      Eigen::Map<Eigen::VectorXd>(z_L, n) = bound_multiplier_lower;
      Eigen::Map<Eigen::VectorXd>(z_U, n) = bound_multiplier_upper;
    }
    return true;
  }

  bool eval_f(Index n, const Number* x, bool /*new_x*/, Number& value) override {
    const Eigen::Map<const Eigen::VectorXd> v(x, n);
    value = 0.5 * v.dot(Q * v) - c.dot(v);
    return true;
  }

  bool eval_grad_f(Index n, const Number* x, bool /*new_x*/, Number* grad) override {
    const Eigen::Map<const Eigen::VectorXd> v(x, n);
    Eigen::Map<Eigen::VectorXd>(grad, n) = Q * v - c;
    return true;
  }

  bool eval_g(Index /*n*/, const Number* /*x*/, bool /*new_x*/, Index /*m*/,
              Number* /*g*/) override {
    return true;
  }

  bool eval_jac_g(Index /*n*/, const Number* /*x*/, bool /*new_x*/, Index /*m*/,
                  Index /*nele_jac*/, Index* /*iRow*/, Index* /*jCol*/,
                  Number* /*values*/) override {
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
          values[k] = factor * Q(i, j);
        }
      }
    }
    return true;
  }

  void finalize_solution(Ipopt::SolverReturn /*status*/, Index n, const Number* x,
                         const Number* /*z_L*/, const Number* /*z_U*/, Index /*m*/,
                         const Number* /*g*/, const Number* /*lambda*/, Number /*value*/,
                         const Ipopt::IpoptData* /*data*/,
                         Ipopt::IpoptCalculatedQuantities* /*quantities*/) override {
    y = Eigen::Map<const Eigen::VectorXd>(x, n);
  }
};

}  // namespace

struct IpoptBoxQp::Engine {
  IpoptSettings settings;
  Ipopt::SmartPtr<Ipopt::IpoptApplication> application;
  Ipopt::SmartPtr<ScaledProblem> problem;
};

IpoptBoxQp::IpoptBoxQp(const IpoptSettings& settings) : engine_(std::make_unique<Engine>()) {
  engine_->settings = settings;
  engine_->application = new Ipopt::IpoptApplication(false);
  engine_->problem = new ScaledProblem;
  auto options = engine_->application->Options();
  options->SetIntegerValue("print_level", 0);
  options->SetStringValue("sb", "yes");
  options->SetStringValue("linear_solver", "mumps");
  options->SetStringValue("hessian_constant", "yes");
  options->SetNumericValue("tol", settings.tolerance);
  options->SetNumericValue("dual_inf_tol", settings.tolerance);
  options->SetNumericValue("compl_inf_tol", settings.tolerance);
  options->SetIntegerValue("max_iter", settings.iteration_limit);
  options->SetNumericValue("bound_relax_factor", 0);
  options->SetStringValue("nlp_scaling_method", "none");
  // A convex QP needs no globalisation: full steps, no second-order correction.
  options->SetStringValue("mehrotra_algorithm", "yes");
  options->SetStringValue("fast_step_computation", "yes");
  options->SetIntegerValue("max_soc", 0);
  options->SetIntegerValue("mumps_permuting_scaling", 0);
  options->SetIntegerValue("mumps_scaling", 0);
  options->SetIntegerValue("mumps_pivot_order", 0);
  if (engine_->application->Initialize() != Ipopt::Solve_Succeeded) {
    throw std::runtime_error("Ipopt did not accept its options");
  }
}

IpoptBoxQp::~IpoptBoxQp() = default;

BoxQpSolution IpoptBoxQp::solve(const BoxQp& qp, const Eigen::VectorXd& start) {
  const Eigen::Index m = qp.b.size();
  BoxQpSolution solution;
  if (m == 0) {
    solution.status = SolveStatus::solved;
    return solution;
  }
  // x = t y with t = β / sqrt(A_ii): unit diagonal and |c| <= 1, so that Ipopt's tolerances mean
  // what IpoptSettings says.
  const Eigen::VectorXd s =
      qp.A.diagonal().array().max(std::numeric_limits<double>::min()).sqrt().inverse();
  const double largest = s.cwiseProduct(qp.b).lpNorm<Eigen::Infinity>();
  const double beta = largest > 0 ? largest : 1;
  ScaledProblem& problem = *engine_->problem;
  problem.Q = s.asDiagonal() * qp.A * s.asDiagonal();
  problem.c = s.cwiseProduct(qp.b) / beta;
  problem.lower = qp.lower.cwiseQuotient(s) / beta;
  problem.upper = qp.upper.cwiseQuotient(s) / beta;
  problem.start = start.cwiseQuotient(s) / beta;

  const Ipopt::ApplicationReturnStatus status =
      engine_->application->OptimizeTNLP(Ipopt::GetRawPtr(engine_->problem));
  if (engine_->application->Statistics().operator->() != nullptr) {
    solution.iterations = engine_->application->Statistics()->IterationCount();
  }
  solution.x = problem.y.size() == m ? (beta * s.cwiseProduct(problem.y)).eval()
                                     : Eigen::VectorXd::Zero(m).eval();
  solution.x = solution.x.cwiseMax(qp.lower).cwiseMin(qp.upper);
  switch (status) {
    case Ipopt::Solve_Succeeded:
    case Ipopt::Solved_To_Acceptable_Level:
      solution.status = SolveStatus::solved;
      break;
    case Ipopt::Diverging_Iterates:
      solution.status = SolveStatus::infeasible;
      break;
    case Ipopt::Maximum_Iterations_Exceeded:
      solution.status = SolveStatus::iteration_limit;
      break;
    default:
      solution.status = SolveStatus::failed;
      solution.message = "Ipopt return code " + std::to_string(static_cast<int>(status));
  }
  return solution;
}

}  // namespace hagfish
