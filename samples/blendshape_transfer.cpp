// A performance drives another character's blendshapes, using the regions where it moves.

#include <iostream>

#include <mimetra/samples/head/head.h>
#include <mimetra/toolkit/formats/model_file.h>
#include <mimetra/toolkit/formats/sequence_file.h>
#include <mimetra/toolkit/mesh/alignment.h>
#include <mimetra/toolkit/regions/regions.h>
#include <mimetra/toolkit/transfer/blendshape_transfer.h>
#include <mimetra/toolkit/transfer/transfer_error.h>
using namespace mimetra;

MeshSequence built_in_performance() {
  const WeightTrack track = samples::parametric_performance();
  const BlendshapeModel person = samples::parametric_head().person(Eigen::Vector4d(1, 0, 0, 0));
  return person.animate(track.weights, track.times).slice(0, 120, 4);
}

BlendshapeModel built_in_actor() {
  return samples::parametric_head().person(Eigen::Vector4d(0, 1, 0, 0));
}

int main(int argc, char** argv) {
  if (argc != 1 && argc != 4) {
    std::cerr << "usage: blendshape_transfer [SEQUENCE MODEL OUT]\n";
    return 2;
  }
  const bool own_files = argc == 4;
  const MeshSequence performance =
      own_files ? rigidly_aligned(read_sequence(argv[1]).sequence) : built_in_performance();
  const BlendshapeModel actor = own_files ? read_blendshapes(argv[2]) : built_in_actor();

  const Components components = decompose(performance, {.count = 10});
  const Regions regions = find_regions(components, {.radius = 0.1 * performance.diameter()});
  const BlendshapeTransfer transfer(performance.rest(), actor, regions.triangles);
  const Eigen::MatrixXd beta = transfer.weights(performance);
  const MeshSequence result = actor.animate(beta, performance.times());
  if (own_files) write_sequence(result, argv[3]);

  // An unmoved actor also has an error: the deformation that was not transferred.
  const MeshSequence still =
      actor.animate(Eigen::MatrixXd::Zero(beta.rows(), beta.cols()), performance.times());
  const double missed = transfer_error(performance, result, regions.triangles).de_all /
                        transfer_error(performance, still, regions.triangles).de_all;
  std::cout << beta.cols() << " weights for " << beta.rows() << " frames from "
            << 100 * regions.triangle_share() << " % of the triangles; " << 100 * (1 - missed)
            << " % of the deformation came across\n";
  return missed < 0.2 && beta.minCoeff() >= 0 && beta.maxCoeff() <= 1 ? 0 : 1;
}
