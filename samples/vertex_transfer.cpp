// A performance moves a mesh without expressions, which only needs the same faces.

#include <iostream>

#include <mimetra/samples/head/head.h>
#include <mimetra/toolkit/formats/sequence_file.h>
#include <mimetra/toolkit/io/mesh_file.h>
#include <mimetra/toolkit/mesh/alignment.h>
#include <mimetra/toolkit/regions/regions.h>
#include <mimetra/toolkit/transfer/transfer_error.h>
#include <mimetra/toolkit/transfer/vertex_transfer.h>
using namespace mimetra;

MeshSequence built_in_performance() {
  const WeightTrack track = samples::parametric_performance();
  const BlendshapeModel person = samples::parametric_head().person(Eigen::Vector4d(1, 0, 0, 0));
  return person.animate(track.weights, track.times).slice(0, 120, 4);
}

TriMesh built_in_character() {
  const BlendshapeModel person = samples::parametric_head().person(Eigen::Vector4d(0, 1, 0, 0));
  return {person.neutral(), person.connectivity()};
}

int main(int argc, char** argv) {
  if (argc != 1 && argc != 4) {
    std::cerr << "usage: vertex_transfer [SEQUENCE MESH OUT]\n";
    return 2;
  }
  const bool own_files = argc == 4;
  const MeshSequence performance =
      own_files ? rigidly_aligned(read_sequence(argv[1]).sequence) : built_in_performance();
  const TriMesh character = own_files ? read_mesh(argv[2]) : built_in_character();

  const Triangles& triangles = character.connectivity.triangles;
  const VertexTransfer transfer(performance.rest(), character.positions, triangles,
                                all_triangles(triangles));
  const MeshSequence result =
      performance.with_frames(transfer.frames(performance)).with_rest(character.positions);
  if (own_files) write_sequence(result, argv[3]);

  // An unmoved character also has an error: the deformation that was not transferred.
  const Positions& neutral = character.positions;
  const Frames one = Eigen::Map<const Frames>(neutral.data(), 1, neutral.size());
  const MeshSequence still = result.with_frames(one.replicate(result.frames(), 1));
  const auto error = [&](const MeshSequence& sequence) {
    return transfer_error(performance, sequence, all_triangles(triangles)).de_all;
  };
  const double missed = error(result) / error(still);
  std::cout << result.frames() << " frames of " << result.vertices() << " vertices; "
            << 100 * (1 - missed) << " % of the deformation came across\n";
  return missed < 0.1 ? 0 : 1;
}
