#include "tests/bench/splocs_bench.h"

#include "toolkit/splocs/motion.h"
#include "toolkit/splocs/start.h"
#include "toolkit/splocs/updates.h"

namespace mimetra::bench {
namespace {

constexpr const char* kGroup = "decomposition";
constexpr int kAdmmSteps = 10;

double motion_bytes(double frames, double vertices) {
  return 8 * frames * 3 * vertices;
}

/// For each component w^T X, what the earlier ones take from it, and one pass over X.
Work start_work(double frames, double vertices, double count, const Machine& machine) {
  const double coordinates = 3 * vertices;
  return {2 * count * frames * coordinates + count * count * coordinates,
          passes(motion_bytes(frames, vertices), count + 1, machine)};
}

/// W H and the differences to P.
Work weight_work(double frames, double count) {
  return {2 * frames * count * count, 3 * 8 * frames * count};
}

/// W^T X, the K x K product of each step, P = X C^T and H = C C^T; X is read once.
Work admm_work(double frames, double vertices, double count) {
  const double coordinates = 3 * vertices;
  return {4 * frames * count * coordinates + 2 * count * count * coordinates * (kAdmmSteps + 1),
          motion_bytes(frames, vertices)};
}

/// What the kernels of one iteration work on.
struct Kernels {
  Reduction reduction;
  std::unique_ptr<BlockSource<double>> X;
  DecompositionOptions options;
  SupportFunction support;
  Start start;
  ComponentUpdate<double> products;
  Frames maps;

  Kernels(const MeshSequence& sequence, int count)
      : reduction(sequence.vertices()),
        X(scaled_motion({sequence.rest(), sequence.triangles(), sequence},
                        MotionScale::root_mean_square, reduction)
              .X),
        options(prepared_options(sequence, count)),
        support(support_function(options.distances, sequence.vertices(), 0.1 * sequence.diameter(),
                                 0.7 * sequence.diameter())),
        start(greedy_start(*X, support, options)),
        products(initial_components(*X, start.components, reduction)) {
    SupportMaps followed(support, count, reduction.part(), {});
    followed.follow(products.C, reduction);
    maps = followed.maps();
  }
};

}  // namespace

DecompositionOptions prepared_options(const MeshSequence& sequence, int count) {
  DecompositionOptions options;
  options.count = count;
  options.iterations = kIterations;
  options.admm_iterations = kAdmmSteps;
  options.tolerance = 0;
  options.distances =
      SurfaceDistances(sequence.rest(), sequence.triangles(), Weld::exact(sequence.rest()));
  decompose(sequence, options);
  return options;
}

Work decomposition_work(double frames, double vertices, double count, const Machine& machine) {
  const Work start = start_work(frames, vertices, count, machine);
  const Work step = admm_work(frames, vertices, count);
  const double coordinates = 3 * vertices;
  const double first_products = 2 * (frames + count) * count * coordinates;
  const double X_bytes = motion_bytes(frames, vertices);
  return {start.flops + first_products + kIterations * step.flops,
          passes(X_bytes, count + 2 + kIterations, machine)};
}

Row decomposition_row(const std::string& name, const MeshSequence& sequence, int count,
                      const Settings& settings) {
  const DecompositionOptions options = prepared_options(sequence, count);
  const Size size{name, sequence.frames(), sequence.vertices(), "K", count};
  const Work work =
      decomposition_work(sequence.frames(), sequence.vertices(), count, settings.machine);
  const Case one{{kGroup, kDecomposition, size, work}, [&] { decompose(sequence, options); }};
  return measured({one}, settings.quick).front();
}

std::vector<Case> splocs_kernel_cases(const std::string& name, const MeshSequence& sequence,
                                      int count, const Settings& settings) {
  const auto kernels = std::make_shared<const Kernels>(sequence, count);
  const double frames = sequence.frames(), vertices = sequence.vertices();
  const Size size{name, sequence.frames(), sequence.vertices(), "K", count};
  // As in the loop of the decomposition, each step takes what the one before gave.
  const Eigen::MatrixXd& W = kernels->start.weights;
  const UpdateWeights weights{W, W.transpose() * W};
  const AdmmOptions admm{kernels->options.sparsity, kernels->options.rho, kAdmmSteps};
  return {{{kGroup, kStart, size, start_work(frames, vertices, count, settings.machine)},
           [kernels] { greedy_start(*kernels->X, kernels->support, kernels->options); }},
          {{kGroup, kWeightStep, size, weight_work(frames, count)},
           [kernels, W = Eigen::MatrixXd(W)]() mutable {
             W = updated_weights(std::move(W), kernels->products.P, kernels->products.H, true);
           }},
          {{kGroup, kAdmm, size, admm_work(frames, vertices, count)},
           [kernels, weights, admm, components = kernels->products]() mutable {
             components = updated_components(*kernels->X, weights, kernels->maps,
                                             std::move(components), admm, kernels->reduction);
           }}};
}

std::vector<Row> splocs_kernel_rows(const std::string& name, const MeshSequence& sequence,
                                    int count, const Settings& settings) {
  return measured(splocs_kernel_cases(name, sequence, count, settings), settings.quick);
}

}  // namespace mimetra::bench
