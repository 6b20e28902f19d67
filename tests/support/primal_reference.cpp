#include "tests/support/primal_reference.hpp"

#include <coin/IpIpoptApplication.hpp>
#include <coin/IpTNLP.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace hagfish {
namespace {

using Ipopt::Index;
using Ipopt::Number;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Ipopt's tolerance. Rows with excess and multiplier both near zero are off by its square root,
/// which is why it is as small as rounding lets it be.
constexpr double tolerance = 1e-14;
/// Ipopt may stop short of `tolerance` at rounding; a point is called solved below this residual.
constexpr double accepted = 1e-11;

/// min ½ z' H z - g' z + weight' s,  J z + (s on soft rows) within [row_lower, row_upper], s >= 0.
class ScaledPrimal final : public Ipopt::TNLP {
 public:
  Eigen::MatrixXd H, J;
  Eigen::VectorXd g, row_lower, row_upper, weight;
  std::vector<Index> soft_row;  ///< row of each slack
  Eigen::VectorXd z, multiplier;

  bool get_nlp_info(Index& n, Index& m, Index& nnz_jac_g, Index& nnz_h_lag,
                    IndexStyleEnum& index_style) override {
    n = static_cast<Index>(g.size() + weight.size());
    m = static_cast<Index>(J.rows());
    nnz_jac_g = static_cast<Index>((J.array() != 0).count() + weight.size());
    nnz_h_lag = 0;
    for (Index j = 0; j < g.size(); ++j) {
      nnz_h_lag += static_cast<Index>((H.col(j).tail(g.size() - j).array() != 0).count());
    }
    index_style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* x_l, Number* x_u, Index m, Number* g_l,
                       Number* g_u) override {
    std::fill_n(x_l, n, -infinity);
    std::fill_n(x_l + g.size(), weight.size(), 0.0);
    std::fill_n(x_u, n, infinity);
    Eigen::Map<Eigen::VectorXd>(g_l, m) = row_lower;
    Eigen::Map<Eigen::VectorXd>(g_u, m) = row_upper;
    return true;
  }

  bool get_starting_point(Index n, bool /*init_x*/, Number* x, bool /*init_z*/, Number* /*z_L*/,
                          Number* /*z_U*/, Index /*m*/, bool /*init_lambda*/,
                          Number* /*lambda*/) override {
    std::fill_n(x, n, 0.0);
    return true;
  }

  bool eval_f(Index /*n*/, const Number* x, bool /*new_x*/, Number& value) override {
    const auto v = velocity(x);
    value = 0.5 * v.dot(H * v) - g.dot(v) + weight.dot(slack(x));
    return true;
  }

  bool eval_grad_f(Index n, const Number* x, bool /*new_x*/, Number* grad) override {
    Eigen::Map<Eigen::VectorXd>(grad, n) << H * velocity(x) - g, weight;
    return true;
  }

  bool eval_g(Index /*n*/, const Number* x, bool /*new_x*/, Index m, Number* value) override {
    Eigen::Map<Eigen::VectorXd> row(value, m);
    row = J * velocity(x);
    for (std::size_t k = 0; k < soft_row.size(); ++k) {
      row[soft_row[k]] += slack(x)[static_cast<Eigen::Index>(k)];
    }
    return true;
  }

  bool eval_jac_g(Index /*n*/, const Number* /*x*/, bool /*new_x*/, Index /*m*/, Index /*nonzeros*/,
                  Index* row, Index* column, Number* values) override {
    Index k = 0;
    const auto entry = [&](Index i, Index j, double value) {
      if (values == nullptr) {
        row[k] = i;
        column[k] = j;
      } else {
        values[k] = value;
      }
      ++k;
    };
    const auto n = static_cast<Index>(g.size());
    for (Index j = 0; j < n; ++j) {
      for (Index i = 0; i < J.rows(); ++i) {
        if (J(i, j) != 0) {
          entry(i, j, J(i, j));
        }
      }
    }
    for (std::size_t s = 0; s < soft_row.size(); ++s) {
      entry(soft_row[s], n + static_cast<Index>(s), 1);
    }
    return true;
  }

  bool eval_h(Index /*n*/, const Number* /*x*/, bool /*new_x*/, Number factor, Index /*m*/,
              const Number* /*lambda*/, bool /*new_lambda*/, Index /*nonzeros*/, Index* row,
              Index* column, Number* values) override {
    Index k = 0;
    for (Index j = 0; j < g.size(); ++j) {
      for (Index i = j; i < g.size(); ++i) {
        if (H(i, j) == 0) {
          continue;
        }
        if (values == nullptr) {
          row[k] = i;
          column[k] = j;
        } else {
          values[k] = factor * H(i, j);
        }
        ++k;
      }
    }
    return true;
  }

  void finalize_solution(Ipopt::SolverReturn /*status*/, Index /*n*/, const Number* x,
                         const Number* /*z_L*/, const Number* /*z_U*/, Index m, const Number* /*g*/,
                         const Number* lambda, Number /*value*/, const Ipopt::IpoptData* /*data*/,
                         Ipopt::IpoptCalculatedQuantities* /*quantities*/) override {
    z = velocity(x);
    multiplier = -Eigen::Map<const Eigen::VectorXd>(lambda, m);  // Ipopt adds λ'g to the objective
  }

 private:
  Eigen::Map<const Eigen::VectorXd> velocity(const Number* x) const { return {x, g.size()}; }
  Eigen::Map<const Eigen::VectorXd> slack(const Number* x) const {
    return {x + g.size(), weight.size()};
  }
};

/// Units of velocity, rows and objective: v = velocity z, rows = row (J z).
struct Units {
  Eigen::VectorXd velocity, row;
  double beta = 1;  ///< the objective's unit is β²
};

/// Unit diagonal of H, unit rows, largest of g, e and d equal to 1.
Units scale(const PrimalQp& qp, ScaledPrimal& problem) {
  Units unit;
  const Eigen::VectorXd s = qp.H.diagonal().cwiseSqrt().cwiseInverse();
  problem.H = s.asDiagonal() * qp.H * s.asDiagonal();
  problem.J = all_rows(qp) * s.asDiagonal();
  const Eigen::VectorXd length = problem.J.rowwise().norm();
  problem.J = length.cwiseInverse().asDiagonal() * problem.J;
  Eigen::VectorXd rhs(length.size());
  rhs << qp.e, qp.d;
  rhs = rhs.cwiseQuotient(length).eval();
  problem.g = s.cwiseProduct(qp.g);
  const double largest = std::max(problem.g.lpNorm<Eigen::Infinity>(),
                                  rhs.size() > 0 ? rhs.lpNorm<Eigen::Infinity>() : 0.0);
  unit.beta = largest > 0 ? largest : 1;
  problem.g /= unit.beta;
  problem.row_lower = rhs / unit.beta;
  problem.row_upper = problem.row_lower;
  problem.row_upper.tail(qp.d.size()).setConstant(infinity);
  unit.velocity = unit.beta * s;
  unit.row = unit.beta * length;
  std::vector<double> weight;
  for (Eigen::Index i = 0; i < qp.cap.size(); ++i) {
    if (std::isfinite(qp.cap[i])) {
      problem.soft_row.push_back(static_cast<Index>(qp.e.size() + i));
      weight.push_back(qp.cap[i] * length[qp.e.size() + i] / unit.beta);
    }
  }
  problem.weight =
      Eigen::Map<Eigen::VectorXd>(weight.data(), static_cast<Eigen::Index>(weight.size()));
  return unit;
}

double residual_of(const ScaledPrimal& p, Eigen::Index equalities) {
  double worst = (p.H * p.z - p.g - p.J.transpose() * p.multiplier).lpNorm<Eigen::Infinity>();
  const Eigen::VectorXd excess = p.J * p.z - p.row_lower;
  Eigen::VectorXd cap = Eigen::VectorXd::Constant(excess.size(), infinity);
  for (std::size_t k = 0; k < p.soft_row.size(); ++k) {
    cap[p.soft_row[k]] = p.weight[static_cast<Eigen::Index>(k)];
  }
  for (Eigen::Index i = 0; i < excess.size(); ++i) {
    const double lambda = p.multiplier[i];
    if (i < equalities) {
      worst = std::max(worst, std::abs(excess[i]));
    } else if (excess[i] >= 0 || std::isinf(cap[i])) {
      worst = std::max({worst, -excess[i], -lambda, std::abs(excess[i] * lambda)});
    } else {
      worst = std::max({worst, lambda - cap[i], std::abs(excess[i] * (cap[i] - lambda))});
    }
  }
  return worst;
}

Ipopt::ApplicationReturnStatus run_ipopt(const Ipopt::SmartPtr<ScaledPrimal>& problem) {
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
  auto options = application->Options();
  options->SetIntegerValue("print_level", 0);
  options->SetStringValue("sb", "yes");
  options->SetStringValue("linear_solver", "mumps");
  options->SetNumericValue("tol", tolerance);
  options->SetIntegerValue("acceptable_iter", 0);
  options->SetNumericValue("bound_relax_factor", 0);
  options->SetStringValue("nlp_scaling_method", "none");
  for (const char* constant : {"hessian_constant", "jac_c_constant", "jac_d_constant"}) {
    options->SetStringValue(constant, "yes");
  }
  if (application->Initialize("") != Ipopt::Solve_Succeeded) {
    throw std::runtime_error("Ipopt did not accept its options");
  }
  return application->OptimizeTNLP(Ipopt::GetRawPtr(problem));
}

}  // namespace

PrimalQpSolution solve_primal(const PrimalQp& qp) {
  check_primal_qp(qp);
  const Ipopt::SmartPtr<ScaledPrimal> problem = new ScaledPrimal;
  const Units unit = scale(qp, *problem);
  const Ipopt::ApplicationReturnStatus code = run_ipopt(problem);
  PrimalQpSolution solution;
  if (problem->z.size() == 0) {
    return solution;
  }
  solution.v = unit.velocity.cwiseProduct(problem->z);
  const Eigen::VectorXd multiplier =
      unit.beta * unit.beta * problem->multiplier.cwiseQuotient(unit.row);
  solution.mu = multiplier.head(qp.e.size());
  solution.lambda = multiplier.tail(qp.d.size());
  solution.residual = residual_of(*problem, qp.e.size());
  if (solution.residual <= accepted) {
    solution.status = SolveStatus::solved;
  } else if (code == Ipopt::Infeasible_Problem_Detected) {
    solution.status = SolveStatus::infeasible;
  } else if (code == Ipopt::Maximum_Iterations_Exceeded) {
    solution.status = SolveStatus::iteration_limit;
  }
  return solution;
}

}  // namespace hagfish
