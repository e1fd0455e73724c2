#include "toolkit/pipeline/rig.h"

#include <algorithm>
#include <utility>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/frame_shapes.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/text.h"
#include "toolkit/model/expression_names.h"
#include "toolkit/model/expression_notes.h"
#include "toolkit/pipeline/measure.h"
#include "toolkit/transfer/following_parts.h"

namespace mimetra {

namespace {

/// Vertices that move less than this share of their expression's largest move count as still.
/// Modelled expressions fade out far beyond the visible motion.
constexpr double kStill = 1e-4;

/// Share of the transfer in the progress; the examples take the rest.
constexpr double kTransferPart = 0.5;

/// Vertices that an expression moves on the source, and the triangles with such a vertex.
Regions moving_part(const Positions& rest, const PositionsView& pose, const Triangles& triangles) {
  const Eigen::VectorXd distances = (pose - rest).rowwise().norm();
  const double least = kStill * distances.maxCoeff();
  Regions moving;
  moving.vertices = static_cast<int>(rest.rows());
  moving.all_triangles = static_cast<int>(triangles.rows());
  for (const double distance : distances) moving.inside.push_back(distance > least);
  for (int t = 0; t < triangles.rows(); ++t) {
    const auto moves = [&](VertexIndex v) { return moving.inside[static_cast<std::size_t>(v)]; };
    if (std::ranges::any_of(triangles.row(t), moves)) moving.triangles.push_back(t);
  }
  return moving;
}

/// Displacements of the target that follow each frame of the source, 3N x D.
class ExpressionTransfer {
 public:
  ExpressionTransfer(const FrameSource& source, const Target& target, const Weld& weld,
                     TriangleWeight triangle_weight, const Context& context)
      : source_(source),
        target_(target),
        options_{.triangle_weight = triangle_weight, .weld = weld, .pairing = target.pairing} {
    const BlendshapeModel& model = target.model;
    displacements_ = Eigen::MatrixXd::Zero(model.neutral().size(), source.frames());
    std::vector<int> slivers(static_cast<std::size_t>(source.frames()), 0);
    if (target.pairing) {
      options_.following = std::make_shared<FollowingParts>(model.neutral(), model.triangles(),
                                                            weld, *target.pairing);
    }
    parallel_for(
        source.frames(), [&](int j) { slivers[j] = transfer(j, context.serial()); }, context);
    slivers_ = std::ranges::max(slivers);
  }

  const Eigen::MatrixXd& displacements() const { return displacements_; }
  /// Largest number of slivers of the target in any expression.
  int slivers() const { return slivers_; }
  /// Parts that follow, with their largest moves in any expression.
  std::vector<FollowingPart> following() const {
    if (!options_.following) return {};
    const BlendshapeModel& model = target_.model;
    const Eigen::Map<const Eigen::RowVectorXd> neutral(model.neutral().data(),
                                                       model.neutral().size());
    const Frames poses = displacements_.transpose().rowwise() + neutral;
    return described(*options_.following, options_.following->farthest(poses), model);
  }

 private:
  /// Returns the number of slivers of the target.
  int transfer(int j, const Context& context) {
    const Frames frame = source_.read(j, 1);
    const PositionsView pose(frame.data(), source_.rest().rows(), 3);
    const Regions moving = moving_part(source_.rest(), pose, source_.triangles());
    const Selection selection = selection_of(moving, target_);
    if (selection.triangles.empty()) return 0;
    VertexTransferOptions of_expression = options_;
    of_expression.inside = selection.inside;
    const BlendshapeModel& model = target_.model;
    const VertexTransfer solver(source_.rest(), model.neutral(), model.triangles(),
                                selection.triangles, of_expression, context);
    const MeshSequence single(source_.shared_connectivity(), frame, {}, source_.rest());
    const Eigen::Map<const Eigen::RowVectorXd> neutral(model.neutral().data(),
                                                       model.neutral().size());
    displacements_.col(j) = (solver.frames(single, context).row(0) - neutral).transpose();
    return solver.degenerate_target_triangles();
  }

  const FrameSource& source_;
  const Target& target_;
  VertexTransferOptions options_;
  Eigen::MatrixXd displacements_;
  int slivers_ = 0;
};

/// Adds the target's own expressions as examples if the source has them, under the same name or
/// another spelling. Given examples have priority.
void add_own_expressions(std::vector<RigExample>& examples, const BlendshapeModel& target,
                         const ShapeBasis& expressions, const Context& context) {
  std::vector<std::string> renamed;
  for (int own = 0; own < target.expressions().size(); ++own) {
    const std::string& name = target.expressions().names[static_cast<std::size_t>(own)];
    const int known = expression_named(name, expressions.names);
    if (known < 0) continue;
    if (const std::string& other = expressions.names[static_cast<std::size_t>(known)];
        other != name) {
      renamed.push_back("'" + name + "' is '" + other + "'");
    }
    const auto is_it = [known](const RigExample& example) {
      const int* expression = std::get_if<int>(&example.meaning);
      return expression && *expression == known;
    };
    if (std::ranges::any_of(examples, is_it)) {
      context.note("the example '" + name + "' replaces the target's own expression");
      continue;
    }
    examples.push_back(
        {name, target.pose(Eigen::VectorXd::Unit(target.expressions().size(), own)), known});
  }
  if (renamed.empty()) return;
  context.note("expressions of the target that the source writes otherwise have its names: " +
               listed(renamed));
}

/// Notes examples in which every vertex is far from the neutral.
void note_places(const std::vector<RigExample>& examples, const BlendshapeModel& model,
                 const Context& context) {
  const double size = diameter(model.neutral(), model.triangles());
  for (const RigExample& example : examples) {
    const double least = least_move(model.neutral(), example.pose, model.triangles());
    if (least < kStillShare * size) continue;
    context.note("example '" + example.name + "': every vertex lies " + readable(least) +
                 " and more from the neutral, in a face of " + readable(size) +
                 "; it seems to stand elsewhere: align it to the neutral (`mimetra align`)");
  }
}

/// Notes examples that equal the neutral.
void note_still(const std::vector<RigExample>& examples, const Positions& neutral,
                const Context& context) {
  std::vector<std::string> still;
  for (const RigExample& example : examples) {
    if (example.pose == neutral) still.push_back(example.name);
  }
  if (still.empty()) return;
  context.note("examples that are the target's neutral: " + listed(still) +
               "; a true shape that does not move makes its expression do nothing");
}

/// Returns the source's expressions on the target, followed by the target's others.
BlendshapeModel with_others(const BlendshapeModel& target, ShapeBasis expressions) {
  const ShapeBasis& own = target.expressions();
  const std::vector<std::string> known = expressions.names;
  for (int j = 0; j < own.size(); ++j) {
    const std::string& name = own.names[static_cast<std::size_t>(j)];
    if (expression_named(name, known) >= 0) continue;
    expressions.names.push_back(name);
    expressions.displacements.conservativeResize(Eigen::NoChange, expressions.names.size());
    expressions.displacements.rightCols<1>() = own.displacements.col(j);
  }
  return {target.shared_connectivity(), target.neutral(), std::move(expressions)};
}

double largest_of(const Eigen::VectorXd& field) {
  return Eigen::Map<const Positions>(field.data(), field.size() / 3, 3).rowwise().norm().maxCoeff();
}

/// Reports on each expression of the model.
std::vector<RiggedExpression> described(const BlendshapeModel& model,
                                        const Eigen::MatrixXd& transferred,
                                        const std::vector<RigExample>& examples) {
  std::vector<RiggedExpression> list;
  for (int j = 0; j < model.expressions().size(); ++j) {
    const Eigen::VectorXd field = model.expressions().displacements.col(j);
    RiggedExpression each{model.expressions().names[static_cast<std::size_t>(j)]};
    each.largest = largest_of(field);
    const auto is_it = [j](const RigExample& example) {
      const int* expression = std::get_if<int>(&example.meaning);
      return expression && *expression == j;
    };
    if (j >= transferred.cols()) {
      each.origin = RigOrigin::own;
    } else {
      each.change = largest_of(field - transferred.col(j));
      if (each.change > 0) each.origin = RigOrigin::corrected;
      if (std::ranges::any_of(examples, is_it)) each.origin = RigOrigin::example;
    }
    list.push_back(std::move(each));
  }
  return list;
}

/// Returns one expression of a model as a sequence.
MeshSequence single_frame(const BlendshapeModel& model, int expression) {
  const Eigen::RowVectorXd weights = Eigen::VectorXd::Unit(model.expressions().size(), expression);
  return model.animate(weights);
}

/// Counts flipped triangles of the source's expressions.
void count_flipped(Rig& rig, const FrameSource& source, const Target& target,
                   const Context& context) {
  const auto count = [&](int j) {
    const MeshSequence single(source.shared_connectivity(), source.read(j, 1), {}, source.rest());
    rig.expressions[j].flipped = transfer_error(single, single_frame(rig.model, j), {},
                                                {.pairing = target.pairing}, context.serial())
                                     .flipped;
  };
  parallel_for(source.frames(), count, context);
}

/// Share of the deformation that the transferred expressions lack.
double missed_by(const BlendshapeModel& transferred, const FrameSource& source,
                 const Target& target, const Context& context) {
  const Eigen::MatrixXd each = Eigen::MatrixXd::Identity(source.frames(), source.frames());
  const Animation animation(std::make_shared<const BlendshapeModel>(transferred), each);
  return missed_share(transfer_error(source, animation, {}, {.pairing = target.pairing}, context));
}

void note_usability(const Rig& rig, const Target& target, const Context& context) {
  std::vector<std::string> flipped, still;
  double all = 0;
  for (const RiggedExpression& each : rig.expressions) {
    all += each.flipped;
    if (each.largest == 0) still.push_back(each.name);
    const double allowed =
        std::max(1.0, kUnusableFlippedShare * static_cast<double>(rig.model.triangles().rows()));
    if (each.flipped > allowed) {
      flipped.push_back(each.name + " (" + std::to_string(each.flipped) + ")");
    }
  }
  if (!still.empty()) {
    context.note(target.name + ": expressions that do not move it: " + listed(still));
  }
  const double triangles =
      static_cast<double>(rig.model.triangles().rows()) * static_cast<double>(rig.weights.cols());
  if (rig.missed > kUnusableMissedShare) {
    context.note(target.name + ": the rig may not be usable: " + percent(rig.missed) +
                 " of the deformation is missing; look whether source and target have the same "
                 "vertices in the same order, or are paired well, and both are neutral");
  }
  if (all > kUnusableFlippedShare * triangles) {
    context.note(target.name + ": the rig may not be usable: flipped triangles in " +
                 listed(flipped) + "; look at these expressions");
  }
}

}  // namespace

void check_sizes(const std::vector<RigExample>& examples, const Positions& neutral,
                 const std::string& name) {
  const double usual = spread(neutral);
  for (const RigExample& example : examples) {
    const double found = spread(example.pose);
    if (!is_other_size(found, usual)) continue;
    throw MismatchError("example '" + example.name + "': its vertices lie " + readable(found) +
                        " from their mean (RMS), those of " + name + " " + readable(usual) +
                        "; bring both into one unit (`mimetra convert --scale X`)");
  }
}

std::shared_ptr<const Animation> frame_of_each_expression(const BlendshapeModel& source) {
  const int count = source.expressions().size();
  if (count == 0) throw MismatchError("the source has no expressions");
  return std::make_shared<const Animation>(std::make_shared<const BlendshapeModel>(source),
                                           Eigen::MatrixXd::Identity(count, count));
}

Rig rig(const BlendshapeModel& source, const Target& given, std::vector<RigExample> examples,
        const RigOptions& options, const Context& context) {
  check_options(options);
  check_options(options.examples);
  const auto frames = frame_of_each_expression(source);
  const Context start = context.part(0, 0), end = context.part(1, 1);
  const MatchedTarget matched(*frames, given, {}, start);
  const Target& target = *matched;
  const Source still = prepare_source(frames, {.model_driven = true}, {}, start.quiet());
  const PlacedSource placed = placed_at(target, still, options.axes, context);
  const FrameSource& sequence = *placed.source.sequence;
  const BlendshapeModel& model = target.model;
  const Weld weld = closed_seams_of(placed.source, target, start);
  const ExpressionTransfer transfer(sequence, target, weld, options.triangle_weight,
                                    context.part(0, kTransferPart));
  if (transfer.slivers() > 0) {
    context.note(target.name + ": " + std::to_string(transfer.slivers()) +
                 " slivers, triangles of hardly any area, follow their neighbours");
  }
  const TargetNotes notes(target.name, context);
  notes.add(transfer.following());
  notes.add_almost_welded(model);
  const BlendshapeModel transferred(model.shared_connectivity(), model.neutral(),
                                    {source.expressions().names, transfer.displacements()});
  check_sizes(examples, model.neutral(), target.name);
  note_places(examples, model, context);
  add_own_expressions(examples, model, source.expressions(), context);
  note_still(examples, model.neutral(), context);
  ExampleRig fitted = fit_to_examples(transferred, examples, weld, options.examples,
                                      context.part(kTransferPart, 1));
  Rig result;
  for (const RigExample& example : examples) result.examples.push_back(example.name);
  result.weights = std::move(fitted.weights);
  result.model = with_others(model, {source.expressions().names, std::move(fitted.displacements)});
  result.expressions = described(result.model, transfer.displacements(), examples);
  result.similarity = placed.similarity;
  result.match = matched.report();
  result.pairing = target.pairing;
  result.missed = missed_by(transferred, sequence, target, end);
  count_flipped(result, sequence, target, end);
  note_usability(result, target, context);
  return result;
}

double rig_bytes(const BlendshapeModel& source, const BlendshapeModel& target) {
  // The transferred expressions, the corrected ones, the model's, and gradients of six numbers per
  // triangle.
  const auto expressions = static_cast<double>(source.expressions().size());
  return sizeof(double) * expressions *
         (3 * 3.0 * target.vertices() + 6.0 * static_cast<double>(target.triangles().rows()));
}

}  // namespace mimetra
