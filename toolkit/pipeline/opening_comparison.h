#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "toolkit/correspondence/automatic_markers.h"
#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// How far an eye or the mouth of a target is open over a sequence, beside the source's: distances
/// of its edges in shares of each face's own opening's width (face_openings.h).
struct ComparedOpening {
  std::string_view name;
  double source_least = 0, source_most = 0;
  double target_least = 0, target_most = 0;
  /// Mean over frames of how much they differ.
  double difference = 0;

  /// The source closes it, the target does not.
  bool stays_open() const;
};

/// An opening of two faces at rest.
struct OpeningAtRest {
  std::string_view name;
  double source = 0, target = 0;  ///< as in ComparedOpening

  /// One of them is open as no face at rest is when the other's is so: it is not neutral.
  bool differs() const;
};

/// Of the openings that both faces have where their landmarks are known.
std::vector<OpeningAtRest> openings_at_rest(const TriMesh& source, const TriMesh& target,
                                            const AutomaticMarkers& markers);

/// An opening that only one of two faces has, as their landmarks show it.
struct LoneOpening {
  std::string_view name;
  bool is_sources = false;
};

/// Those of two faces at rest. The other's landmarks are likely not on the edges of its opening,
/// such as on an eyeball or inside of the socket, where they mislead whoever pairs the two.
std::vector<LoneOpening> lone_openings(const TriMesh& source, const TriMesh& target,
                                       const AutomaticMarkers& markers);

/// Of the openings that both faces have where their landmarks are known. `result` follows `source`
/// frame by frame; the rest poses are neutral. Throws MismatchError for other numbers of frames,
/// what reading throws, Cancelled.
std::vector<ComparedOpening> compared_openings(const FrameSource& source, const FrameSource& result,
                                               const AutomaticMarkers& markers,
                                               const Context& context = {});

}  // namespace mimetra
