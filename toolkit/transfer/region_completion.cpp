#include "toolkit/transfer/region_completion.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Eigenvalues>

#include "toolkit/mesh/near_tie.h"
#include "toolkit/mesh/product_blocking.h"
#include "toolkit/transfer/blendshape_transfer.h"

namespace mimetra {

namespace {

/// Displacements of which too little is seen, and what they are called.
struct Unseen {
  Eigen::VectorXd field;  // 3N
  std::string name;
};

/// What some triangles show of a target's expressions.
class View {
 public:
  /// `open` are the triangles that discs may hold.
  View(const BlendshapeModel& target, const Regions& regions, const std::vector<int>& open,
       EdgeSum edges)
      : target_(target),
        edges_(edges),
        all_(gram_matrix(target, open, edges)),
        is_seen_(target.triangles().rows(), true) {
    for (const int triangle : open) is_seen_[triangle] = false;
    std::vector<int> seen;
    std::ranges::copy_if(regions.triangles, std::back_inserter(seen),
                         [this](int triangle) { return !is_seen_[triangle]; });
    seen_ = gram_matrix(target, seen, edges);
    for (const int triangle : seen) is_seen_[triangle] = true;
    const double most = all_.diagonal().maxCoeff();
    for (Eigen::Index j = 0; j < all_.rows(); ++j) {
      if (moves_there(all_(j, j), most)) moving_.push_back(j);
    }
    can_be_told_apart_ = !moving_.empty() && tells_apart(directions(all_).eigenvalues());
  }

  /// The expression of which the smallest share is seen, or the combination that triangles hardly
  /// tell from none, where less than `share` of it is seen.
  std::optional<Unseen> least_seen(double share) const {
    if (moving_.empty()) return {};
    const Eigen::VectorXd shares = (seen_.diagonal().array() / all_.diagonal().array())(moving_);
    const double least = shares.minCoeff();
    if (least < share) {
      const auto is_least = [&](double x) { return x <= least + kNearTie; };
      const Eigen::Index j = moving_[std::ranges::find_if(shares, is_least) - shares.begin()];
      return Unseen{displacements().col(j), target_.expressions().names[j]};
    }
    return hardly_told_apart(share);
  }

  /// What the triangles that are not seen hold of a field (M).
  Eigen::VectorXd missing(const Eigen::VectorXd& field) const {
    Eigen::VectorXd motion = motion_of_triangles(target_, field, edges_);
    for (Eigen::Index t = 0; t < motion.size(); ++t) {
      if (is_seen_[t]) motion[t] = 0;
    }
    return motion;
  }

  /// Triangles of the disc that are not seen.
  std::vector<int> unseen(const Disc& disc) const {
    std::vector<int> triangles;
    std::ranges::copy_if(disc.triangles, std::back_inserter(triangles),
                         [this](int triangle) { return !is_seen_[triangle]; });
    return triangles;
  }

  void add(const std::vector<int>& triangles) {
    seen_ += gram_matrix(target_, triangles, edges_);
    for (const int triangle : triangles) is_seen_[triangle] = true;
  }

 private:
  const Eigen::MatrixXd& displacements() const { return target_.expressions().displacements; }

  /// Combinations of the expressions that move, from the one that is seen least.
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> directions(const Eigen::MatrixXd& gram) const {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(gram(moving_, moving_));
  }

  /// Of a Gram matrix' eigenvalues, ascending.
  static bool tells_apart(const Eigen::VectorXd& values) {
    return values[values.size() - 1] <= kPoorCondition * values[0];
  }

  std::optional<Unseen> hardly_told_apart(double share) const {
    const auto seen = directions(seen_);
    if (tells_apart(seen.eigenvalues())) return {};
    const Eigen::VectorXd combination = seen.eigenvectors().col(0);
    const double moves = combination.dot(all_(moving_, moving_) * combination);
    if (!moves_there(moves, all_.diagonal().maxCoeff())) return {};
    if (!can_be_told_apart_ && seen.eigenvalues()[0] >= share * moves) return {};
    return Unseen{displacements()(Eigen::all, moving_) * combination,
                  "a combination of expressions"};
  }

  const BlendshapeModel& target_;
  EdgeSum edges_;
  Eigen::MatrixXd all_, seen_;        // A^T A of eq. 11 (D x D)
  std::vector<bool> is_seen_;         // or cannot be
  std::vector<Eigen::Index> moving_;  // expressions that move anything
  bool can_be_told_apart_ = false;    // by all triangles
};

/// Triangles with a vertex that discs may hold.
std::vector<int> open_triangles(const Triangles& triangles, const DiscSearch& search) {
  std::vector<int> open = all_triangles(triangles);
  std::erase_if(open, [&](int t) {
    return std::ranges::none_of(triangles.row(t),
                                [&](VertexIndex v) { return search.is_inside(v); });
  });
  return open;
}

}  // namespace

CompletedRegions completed(const Regions& regions, const BlendshapeModel& target,
                           DiscSearch& search, const CompletionOptions& options) {
  check_options(options);
  CompletedRegions result{regions};
  if (options.share == 0) return result;
  fix_product_blocking();
  View view(target, regions, open_triangles(target.triangles(), search), options.edges);
  double room = options.limit * static_cast<double>(regions.all_triangles);
  std::vector<Region> discs;
  while (const auto unseen = view.least_seen(options.share)) {
    const Disc disc = search.best(view.missing(unseen->field));
    const std::vector<int> triangles = view.unseen(disc);
    room -= static_cast<double>(triangles.size());
    result.limited = room < 0;
    if (triangles.empty() || result.limited) break;
    view.add(triangles);
    Region& region = discs.emplace_back();
    region.center = disc.center;
    region.radius = search.radius();
    region.vertices = disc.vertices;
    region.added_for = unseen->name;
  }
  result.added = static_cast<int>(discs.size());
  result.regions = with_added(regions, std::move(discs), target.triangles());
  return result;
}

}  // namespace mimetra
