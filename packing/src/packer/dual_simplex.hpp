// Solves the small linear programme at the heart of the search.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "packer/ball.hpp"

namespace innersphere {

/// Maximises the smallest of a few linear functions over a cube about the origin:
///   max over |y_j| <= half of min over k of (value_k + gradient_k . y).
/// Functions are rounded and added one by one; after each the optimum is restored by the dual simplex method,
/// with a basis of four of the functions and faces of the cube.
class DualSimplex {
 public:
  /// Begins with a cube and without functions; also a first time.
  void restart(double half);

  /// Adds a function and finds the new optimum.
  void add(double value, const Point& gradient);

  /// Returns how many functions were added.
  int size() const { return static_cast<int>(rows_.size()) - kFaces; }
  double optimum() const { return optimum_[0]; }
  Point argmax() const { return optimum_.tail<3>(); }

  /// Calls visit(k, weight) for the functions that hold the optimum down. Weights are positive and sum to 1;
  /// with them, the weighted sum of the functions has its maximum over the cube at the optimum, too.
  template <class Visit>
  void forWeights(Visit&& visit) const {
    double sum = 0;
    for (int i = 0; i < 4; ++i) sum += weightAt(i);
    for (int i = 0; i < 4; ++i) {
      if (weightAt(i) > 0) visit(basis_[i] - kFaces, weightAt(i) / sum);
    }
  }

 private:
  static constexpr int kFaces = 6;

  /// This is a constraint normal . (optimum, y) <= bound.
  struct Row {
    Eigen::Vector4d normal;
    double bound;
    double excess(const Eigen::Vector4d& z) const { return normal.dot(z) - bound; }
  };

  void start();
  void enter(int row);
  void findOptimum();
  double weightAt(int i) const { return basis_[i] < kFaces ? 0.0 : std::max(0.0, inverse_(0, i)); }

  double unit_ = 1;        // of what is rounded
  std::vector<Row> rows_;  // the faces of the cube, then the functions
  int basis_[4] = {};
  Eigen::Matrix4d inverse_;  // of the matrix of the basis' normals; its first row holds the dual variables
  Eigen::Vector4d optimum_;  // (value, y)
};

}  // namespace innersphere
