#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "toolkit/mesh/alignment.h"
#include "toolkit/mesh/progress.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/operation.h"
#include "toolkit/regions/regions.h"

namespace mimetra {

/// Parameters shared by the operations that look for regions; each group is read by the function of
/// the same name.
std::vector<Parameter> alignment_parameters();
std::vector<Parameter> geodesic_parameters();
std::vector<Parameter> decomposition_parameters(int count);
std::vector<Parameter> region_parameters();

/// What the head's motion is found on; `none` looks for none.
enum class HeadMotion { stable, all, none };

/// As people choose it.
constexpr std::string_view choice_name(HeadMotion value) {
  switch (value) {
    case HeadMotion::stable:
      return "stable";
    case HeadMotion::all:
      return "all";
    case HeadMotion::none:
      return "none";
  }
  return {};
}

/// Found by a fit, or read from the manifest of an align run.
using HeadMotionSource = std::variant<HeadMotion, std::filesystem::path>;

/// What --align says, or its default: none where the neutral is known.
HeadMotionSource alignment_of(const Invocation& invocation, const SequenceRead& read);

/// Applies --align to what was read; the motion is empty where none was looked for.
Alignment without_motion(const Invocation& invocation, const SequenceRead& read,
                         const MeshSequence& sequence);

/// Distances by --geodesics and --weld; warns of triangles and vertices that had to be left out.
SurfaceDistances distances_on(const Invocation& invocation, const Positions& rest,
                              const Triangles& triangles);

/// Components of a sequence, and the distances on its decomposition's rest pose.
struct Analysis {
  Components components;
  SurfaceDistances distances;
  double seconds = 0;
};

/// Applies -k, --d-min and the like to a sequence. `count` overrides -k.
Analysis analyse(const Invocation& invocation, const SequenceRead& read,
                 const MeshSequence& sequence, int count, const Progress& progress);

/// The output `components-out` of operations that decompose on the way to something else.
Output components_output();

/// Components given as the input `components`, or those of the sequence without its motion.
Analysis analysis_for(const Invocation& invocation, const SequenceRead& read);

/// Applies --radius, --region and --coverage.
Regions regions_of(const Invocation& invocation, const Analysis& analysis);

/// What operations report about regions: keys regions, vertices, triangles, vertex_share, ...
Json report_of(const Regions& regions);
std::string summary_of(const Regions& regions);

/// Positions of `text` (a mesh file), checked against a sequence's vertex count.
Positions read_rest(const std::string& text, const MeshSequence& sequence);

/// A motion of `frames` frames as align's manifest keeps it. Throws IoError, MismatchError.
std::vector<RigidTransform> read_motion(const std::string& path, int frames);

/// Geodesic distances between which a support map rises, in the file's unit.
struct SupportRange {
  double d_min;
  double d_max;
};

/// Applies --d-min and --d-max to a mesh whose longest side is `unit`. Throws UsageError.
SupportRange support_range(const Parameters& parameters, double unit);

}  // namespace mimetra
