// Writes the regions where a sequence moves as a time series for ParaView.

#include <iostream>

#include <mimetra/samples/head/head.h>
#include <mimetra/toolkit/formats/sequence_file.h>
#include <mimetra/toolkit/mesh/alignment.h>
#include <mimetra/toolkit/regions/regions.h>
#include <mimetra/toolkit/vtk/vtp_series.h>
using namespace mimetra;

MeshSequence built_in_performance() {
  const WeightTrack track = samples::parametric_performance();
  return samples::parametric_head().person().animate(track.weights, track.times).slice(0, 120, 4);
}

int main(int argc, char** argv) {
  if (argc != 1 && argc != 3) {
    std::cerr << "usage: regions_to_paraview [SEQUENCE NAME.pvd]\n";
    return 2;
  }
  const bool own_files = argc == 3;
  const MeshSequence performance =
      own_files ? rigidly_aligned(read_sequence(argv[1]).sequence) : built_in_performance();
  const char* target = own_files ? argv[2] : "regions.pvd";

  const Components components = decompose(performance, {.count = 10});
  const Regions regions = find_regions(components, {.radius = 0.1 * performance.diameter()});
  const auto files =
      write_vtp_series({performance, fields_of(regions)}, target, {.overwrite = !own_files});

  std::cout << regions.regions.size() << " regions on " << regions.vertex_count() << " of "
            << regions.vertices << " vertices hold " << 100 * regions.energy_share
            << " % of the motion; open " << target << " in ParaView\n";

  // ParaView will show the regions that were found: check every file but the indices.
  int frames = 0;
  for (const auto& file : files) {
    if (file.extension() != ".vtp") continue;
    ++frames;
    if (read_vtp_field(file, "roi").sum() != regions.vertex_count()) return 1;
  }
  return frames == performance.frames() ? 0 : 1;
}
