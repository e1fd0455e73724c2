#include "tests/bench/subjects.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>
#include <utility>

#include "samples/head/head.h"
#include "tests/test_folders.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/io/weight_file.h"
#include "toolkit/mesh/measures.h"
#include "toolkit/model/animation.h"

namespace mimetra::bench {
namespace {

/// Every triangle split in four at the middles of its edges; old vertices come first.
struct Refinement {
  /// Ends of the edge that each vertex halves; an old vertex twice.
  std::vector<std::pair<int, int>> ends;
  Triangles triangles;

  Refinement(int vertices, const Triangles& coarse) : triangles(4 * coarse.rows(), 3) {
    for (int v = 0; v < vertices; ++v) ends.emplace_back(v, v);
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const std::pair<int, int> edge = std::minmax(a, b);
      const auto [entry, added] = middles.try_emplace(edge, static_cast<int>(ends.size()));
      if (added) ends.push_back(edge);
      return entry->second;
    };
    for (Eigen::Index t = 0; t < coarse.rows(); ++t) {
      const int a = coarse(t, 0), b = coarse(t, 1), c = coarse(t, 2);
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      triangles.row(4 * t) << a, ab, ca;
      triangles.row(4 * t + 1) << ab, b, bc;
      triangles.row(4 * t + 2) << ca, bc, c;
      triangles.row(4 * t + 3) << ab, bc, ca;
    }
  }

  /// x y z of every vertex one below the other, a column for each field.
  Eigen::MatrixXd refined(const Eigen::MatrixXd& fields) const {
    Eigen::MatrixXd fine(3 * static_cast<Eigen::Index>(ends.size()), fields.cols());
    for (std::size_t v = 0; v < ends.size(); ++v) {
      fine.middleRows<3>(3 * static_cast<Eigen::Index>(v)) =
          (fields.middleRows<3>(3 * ends[v].first) + fields.middleRows<3>(3 * ends[v].second)) / 2;
    }
    return fine;
  }
};

BlendshapeModel refined(const BlendshapeModel& model) {
  const Refinement refinement(model.vertices(), model.triangles());
  const Eigen::Map<const Eigen::VectorXd> neutral(model.neutral().data(), model.neutral().size());
  const Eigen::MatrixXd fine = refinement.refined(neutral);
  const int vertices = static_cast<int>(refinement.ends.size());
  return {std::make_shared<const Connectivity>(
              Connectivity::from_triangles(vertices, refinement.triangles)),
          PositionsView(fine.data(), vertices, 3),
          {model.expressions().names, refinement.refined(model.expressions().displacements)}};
}

/// Rows in between by straight lines.
Eigen::MatrixXd resampled(const Eigen::MatrixXd& rows, int count) {
  Eigen::MatrixXd result(count, rows.cols());
  for (int f = 0; f < count; ++f) {
    const double place = static_cast<double>(f) * static_cast<double>(rows.rows() - 1) / count;
    const auto before = static_cast<Eigen::Index>(place);
    const double share = place - static_cast<double>(before);
    result.row(f) = (1 - share) * rows.row(before) + share * rows.row(before + 1);
  }
  return result;
}

std::optional<Subject> captured(const std::string& name, const std::string& model,
                                const std::string& source, const std::string& target,
                                const std::string& capture, int frames) {
  const auto folder = test::shared_path("data") / model;
  const auto weights = test::shared_path("data/captures") / capture;
  if (!std::filesystem::exists(folder) || !std::filesystem::exists(weights)) return {};
  const BlendshapeModel actor = read_blendshapes(folder.string() + source);
  const WeightTrack track = read_weights(weights);
  const Eigen::MatrixXd beta = weights_for(track, actor.expressions().names);
  const BlendshapeModel other = read_blendshapes(folder.string() + target);
  return Subject{name, actor.animate(beta.topRows(frames), track.times.head(frames)), other,
                 folder.string() + target, other.animate(beta.topRows(frames))};
}

/// Expressions NAME_L and NAME_R as one.
BlendshapeModel without_sides(const BlendshapeModel& model) {
  const ShapeBasis& given = model.expressions();
  std::map<std::string, Eigen::VectorXd> fields;
  for (int j = 0; j < given.size(); ++j) {
    const std::string& name = given.names[static_cast<std::size_t>(j)];
    const bool has_side = name.ends_with("_L") || name.ends_with("_R");
    const auto [entry, added] = fields.try_emplace(
        has_side ? name.substr(0, name.size() - 2) : name, given.displacements.col(j));
    if (!added) entry->second += given.displacements.col(j);
  }
  ShapeBasis basis{{}, Eigen::MatrixXd(given.displacements.rows(), fields.size())};
  for (const auto& [name, field] : fields) {
    basis.displacements.col(basis.size()) = field;
    basis.names.push_back(name);
  }
  return {model.shared_connectivity(), model.neutral(), std::move(basis)};
}

/// Left and right, above and below, with soft borders of a fifth of the diameter between them.
RegionShares quarters_of(const Positions& neutral) {
  const Eigen::RowVector3d center = neutral.colwise().mean();
  const double border = 0.2 * diameter(neutral);
  const auto share = [&](Eigen::Index v, int axis) {
    const double t = std::clamp((neutral(v, axis) - center[axis]) / border + 0.5, 0.0, 1.0);
    return t * t * (3 - 2 * t);
  };
  Eigen::MatrixXd shares(neutral.rows(), 4);
  for (Eigen::Index v = 0; v < neutral.rows(); ++v) {
    const double right = share(v, 0), up = share(v, 1);
    shares.row(v) << right * up, right * (1 - up), (1 - right) * up, (1 - right) * (1 - up);
  }
  return shares.sparseView(1, 0);
}

/// The weights of four quarters: each is a quarter of the clip ahead of the one before, and gives
/// every weight to the next expression.
Eigen::MatrixXd in_quarters(const Eigen::MatrixXd& beta) {
  const Eigen::Index frames = beta.rows(), expressions = beta.cols();
  Eigen::MatrixXd result(frames, 4 * expressions);
  for (Eigen::Index q = 0; q < 4; ++q) {
    for (Eigen::Index f = 0; f < frames; ++f) {
      for (Eigen::Index j = 0; j < expressions; ++j) {
        result(f, q * expressions + j) = beta((f + q * frames / 4) % frames, (j + q) % expressions);
      }
    }
  }
  return result;
}

/// Stretched, and bent forwards above and below.
Positions bent(const Positions& positions) {
  Positions result = positions;
  result.col(0) = 0.9 * positions.col(0) + 0.002 * positions.col(1).cwiseAbs2();
  result.col(1) = 1.25 * positions.col(1);
  return result;
}

BlendshapeModel bent(const BlendshapeModel& model) {
  const Positions neutral = bent(model.neutral());
  ShapeBasis expressions = model.expressions();
  for (auto field : expressions.displacements.colwise()) {
    const PositionsView displacement(field.data(), model.vertices(), 3);
    const Positions moved = bent(model.neutral() + displacement) - neutral;
    field = Eigen::Map<const Eigen::VectorXd>(moved.data(), moved.size());
  }
  return {model.shared_connectivity(), neutral, std::move(expressions)};
}

}  // namespace

Subject head(int splits, int frames) {
  const MorphableModel model = samples::parametric_head();
  BlendshapeModel source = model.person(Eigen::Vector4d(0, 1, 0, 0));
  BlendshapeModel target = model.person(Eigen::Vector4d(0, 0, 1, 0));
  for (int split = 0; split < splits; ++split) {
    source = refined(source);
    target = refined(target);
  }
  const Eigen::MatrixXd beta =
      weights_for(samples::parametric_performance(), source.expressions().names);
  return {"head", source.animate(resampled(beta, frames)), std::move(target)};
}

std::optional<Subject> surrey() {
  return captured("Surrey", "sfm", "@0=1,1=-1", "@0=-1,2=1.5", "six-expressions-25fps-100.csv",
                  100);
}

std::optional<Subject> quartered_surrey() {
  const auto folder = test::shared_path("data/sfm");
  const auto weights = test::shared_path("data/captures/six-expressions-25fps-100.csv");
  if (!std::filesystem::exists(folder) || !std::filesystem::exists(weights)) return {};
  const auto person = [&](const char* identity) {
    return std::make_shared<const BlendshapeModel>(read_blendshapes(folder.string() + identity));
  };
  const auto actor = person("@0=1,1=-1"), other = person("@0=-1,2=1.5");
  const WeightTrack track = read_weights(weights);
  const Eigen::MatrixXd beta = in_quarters(weights_for(track, actor->expressions().names));
  const RegionShares shares = quarters_of(actor->neutral());
  const auto performed = [&](const std::shared_ptr<const BlendshapeModel>& model) {
    return MeshSequence(RegionalAnimation(model, shares, beta, track.times));
  };
  return Subject{"Surrey, in quarters", performed(actor), *other, folder.string() + "@0=-1,2=1.5",
                 performed(other)};
}

std::optional<Subject> ict(int frames) {
  return captured("ICT", "ict-face", "@identity003=1.5", "@identity007=2", "talking-60fps-1200.csv",
                  frames);
}

std::optional<Subject> symmetric_ict(int frames) {
  std::optional<Subject> subject = ict(frames);
  if (!subject) return {};
  subject->name = "ICT, symmetric target";
  subject->target = without_sides(subject->target);
  subject->target_text.clear();
  return subject;
}

std::optional<Subject> bent_facecap() {
  const auto folder = test::shared_path("data/facecap");
  if (!std::filesystem::exists(folder)) return {};
  const BlendshapeModel actor = read_blendshapes(folder.string());
  const Eigen::MatrixXd beta =
      weights_for(read_weights(folder / "weights.csv"), actor.expressions().names);
  return Subject{"facecap", actor.animate(beta), bent(actor)};
}

Subject first_frames(const Subject& subject, int frames) {
  return {subject.name, subject.performance.slice(0, frames), subject.target, subject.target_text};
}

std::vector<int> triangles_around_motion(const Subject& subject, double share) {
  const Eigen::MatrixXd& fields = subject.target.expressions().displacements;
  Eigen::VectorXd motion(subject.target.vertices());
  for (Eigen::Index v = 0; v < motion.size(); ++v) {
    motion[v] = fields.middleRows<3>(3 * v).squaredNorm();
  }
  Eigen::Index center = 0;
  motion.maxCoeff(&center);
  const Positions& neutral = subject.target.neutral();
  const Eigen::VectorXd distances = (neutral.rowwise() - neutral.row(center)).rowwise().norm();
  const Triangles& triangles = subject.target.triangles();
  std::vector<int> order(static_cast<std::size_t>(triangles.rows()));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](int t) { return distances[triangles(t, 0)]; });
  order.resize(static_cast<std::size_t>(share * static_cast<double>(order.size())));
  std::ranges::sort(order);
  return order;
}

}  // namespace mimetra::bench
