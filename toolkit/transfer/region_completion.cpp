#include "toolkit/transfer/region_completion.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Eigenvalues>

#include "toolkit/mesh/rounding.h"
#include "toolkit/transfer/blendshape_transfer.h"

namespace mimetra {

namespace {

/// Displacements that the regions show too little, and their name.
struct Unseen {
  Eigen::VectorXd field;  // 3N
  std::string name;
};

/// Visibility of a target's expressions in some triangles. `open`, regions and discs consist of the
/// source's triangles. All other triangles are the target's.
class View {
 public:
  /// `open` are the triangles that discs may contain.
  View(const BlendshapeModel& target, const Regions& regions, const std::vector<int>& open,
       const CompletionOptions& options)
      : target_(target),
        edges_(options.edges),
        pairing_(options.pairing.get()),
        in_discs_(regions.triangles),
        is_seen_(target.triangles().rows(), true) {
    const std::vector<int> over_open = over(open);
    all_ = gram_matrix(target, over_open, edges_);
    for (const int triangle : over_open) is_seen_[triangle] = false;
    std::vector<int> seen;
    std::ranges::copy_if(over(in_discs_), std::back_inserter(seen),
                         [this](int triangle) { return !is_seen_[triangle]; });
    seen_ = gram_matrix(target, seen, edges_);
    for (const int triangle : seen) is_seen_[triangle] = true;
    const double most = all_.diagonal().maxCoeff();
    for (Eigen::Index j = 0; j < all_.rows(); ++j) {
      if (moves_there(all_(j, j), most)) moving_.push_back(j);
    }
    can_be_told_apart_ = !moving_.empty() && tells_apart(directions(all_).eigenvalues());
  }

  /// Returns the expression with the smallest visible share, if that is below `share`. Otherwise
  /// returns the combination of expressions that the triangles hardly distinguish from none, if
  /// there is one.
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

  /// Motion of a field in unseen triangles, summed at the source's triangles (M).
  Eigen::VectorXd missing(const Eigen::VectorXd& field) const {
    Eigen::VectorXd motion = motion_of_triangles(target_, field, edges_);
    for (Eigen::Index t = 0; t < motion.size(); ++t) {
      if (is_seen_[t]) motion[t] = 0;
    }
    return pairing_ ? at_partners(motion) : motion;
  }

  /// Unseen triangles that the disc would show.
  std::vector<int> unseen(const Disc& disc) const {
    std::vector<int> with_disc = pairing_ ? in_discs_ : std::vector<int>();
    with_disc.insert(with_disc.end(), disc.triangles.begin(), disc.triangles.end());
    std::vector<int> triangles;
    std::ranges::copy_if(over(with_disc), std::back_inserter(triangles),
                         [this](int triangle) { return !is_seen_[triangle]; });
    return triangles;
  }

  void add(const Disc& disc) {
    const std::vector<int> triangles = unseen(disc);
    in_discs_.insert(in_discs_.end(), disc.triangles.begin(), disc.triangles.end());
    seen_ += gram_matrix(target_, triangles, edges_);
    for (const int triangle : triangles) is_seen_[triangle] = true;
  }

 private:
  /// Target triangles over the source's `triangles`.
  std::vector<int> over(const std::vector<int>& triangles) const {
    return pairing_ ? triangles_over(pairing_->triangles(), triangles) : triangles;
  }

  Eigen::VectorXd at_partners(const Eigen::VectorXd& amounts) const {
    const Correspondence& pairs = pairing_->triangles();
    Eigen::VectorXd result = Eigen::VectorXd::Zero(pairs.source_triangles);
    for (int t = 0; t < pairs.target_triangles(); ++t) {
      for (int p = pairs.offsets[t]; p < pairs.offsets[t + 1]; ++p) {
        result[pairs.parts[p].triangle] += pairs.parts[p].weight * amounts[t];
      }
    }
    return result;
  }

  const Eigen::MatrixXd& displacements() const { return target_.expressions().displacements; }

  /// Eigenvectors of the moving expressions' Gram matrix, from the least visible combination.
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> directions(const Eigen::MatrixXd& gram) const {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(gram(moving_, moving_));
  }

  /// Returns true for the eigenvalues (ascending) of a well-conditioned Gram matrix.
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
  const Pairing* pairing_;
  std::vector<int> in_discs_;         // triangles of the source in regions and discs
  Eigen::MatrixXd all_, seen_;        // A^T A of eq. 11 (D x D)
  std::vector<bool> is_seen_;         // or cannot be seen
  std::vector<Eigen::Index> moving_;  // expressions with motion where discs may lie
  bool can_be_told_apart_ = false;    // by all open triangles
};

/// Triangles with a vertex that discs may contain.
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
  const Triangles& of_source =
      options.pairing ? options.pairing->source_triangles() : target.triangles();
  View view(target, regions, open_triangles(of_source, search), options);
  double room = options.limit * static_cast<double>(target.triangles().rows());
  std::vector<Region> discs;
  while (const auto unseen = view.least_seen(options.share)) {
    const Disc disc = search.best(view.missing(unseen->field));
    const std::vector<int> triangles = view.unseen(disc);
    room -= static_cast<double>(triangles.size());
    result.limited = room < 0;
    if (triangles.empty() || result.limited) break;
    view.add(disc);
    Region& region = discs.emplace_back();
    region.center = disc.center;
    region.radius = search.radius();
    region.vertices = disc.vertices;
    region.added_for = unseen->name;
  }
  result.added = static_cast<int>(discs.size());
  result.regions = with_added(regions, std::move(discs), of_source);
  return result;
}

}  // namespace mimetra
