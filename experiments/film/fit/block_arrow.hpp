// Symmetric positive definite matrices of a chain of blocks, each coupled with the two before it,
// and a border that is coupled with all: solved, and their inverse near the diagonal.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

namespace hagfish {

/// The matrix, of `blocks` x `size` rows and then `border` ones, and its right-hand side. It takes
/// O(blocks size^3) to solve. Pairs of blocks are kept as one, so that the chain is tridiagonal.
class BlockArrow {
 public:
  BlockArrow(Eigen::Index blocks, Eigen::Index size, Eigen::Index border);

  /// Sets all to 0.
  void clear();
  /// Adds to the block of rows `i`, columns `j`, at most two apart; and its transpose to (j, i) for
  /// i != j.
  void add(Eigen::Index i, Eigen::Index j, const Eigen::MatrixXd& part);
  void add_diagonal(Eigen::Index i, Eigen::Index row, Eigen::Index column, double value);
  void add_border(Eigen::Index i, const Eigen::MatrixXd& part);  ///< size x border
  Eigen::MatrixXd& corner() { return corner_; }                  ///< border x border
  /// The diagonal, the border's at the end.
  Eigen::VectorXd diagonal() const;

  /// Factors it with `damping` times its diagonal added; false where it is not positive definite.
  bool factor(double damping);
  /// The solution for a right-hand side of blocks x size + border rows; after factor().
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;

  /// The inverse's blocks on the diagonal and one and two below; after factor().
  struct Inverse {
    std::vector<Eigen::MatrixXd> own, one_below, two_below;  ///< (i, i), (i + 1, i), (i + 2, i)
  };
  Inverse inverse() const;

 private:
  Eigen::MatrixXd chain_solve(const Eigen::MatrixXd& right) const;

  Eigen::Index blocks_, size_, border_, pairs_;
  std::vector<Eigen::MatrixXd> own_, below_, beside_;  // pairs: (K, K), (K + 1, K), border
  Eigen::MatrixXd corner_;
  std::vector<Eigen::LLT<Eigen::MatrixXd>> factor_;
  std::vector<Eigen::MatrixXd> ahead_;  // own^-1 below' of factored pairs
  Eigen::MatrixXd beside_solved_;       // chain^-1 border
  Eigen::LLT<Eigen::MatrixXd> corner_factor_;
};

}  // namespace hagfish
