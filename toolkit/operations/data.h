#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "toolkit/io/fit_file.h"
#include "toolkit/io/sequence_file.h"
#include "toolkit/io/weight_track.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/model/landmark_track.h"
#include "toolkit/model/morphable_model.h"
#include "toolkit/operations/image.h"
#include "toolkit/operations/run_file.h"
#include "toolkit/regions/regions.h"
#include "toolkit/splocs/decomposition.h"

namespace mimetra {

/// What goes into operations and comes out of them.
enum class DataKind {
  sequence,
  model,
  components,
  regions,
  fields,
  table,
  animated_model,
  picture,
  landmarks,
  morphable_model,
  fit,
  pictures,
  view,
  run,
  page
};

/// "sequence", as in the JSON of the operations table.
std::string_view kind_name(DataKind kind);

/// Regions and the sequence they are shown on (empty for regions that were read).
struct RegionData {
  Regions regions;
  FieldSequence fields;
  /// Faces of those that were made for a mesh without a sequence, or null.
  std::shared_ptr<const Connectivity> faces = {};
  /// The frames of a sequence that is not in memory, or null; `fields` then has none.
  std::shared_ptr<const FrameSource> stream = {};
};

/// How regions that were written are shown.
struct RegionView {
  RegionData regions;
  std::filesystem::path series;  ///< where they are: .pvd or .vtp
};

/// Rows of numbers under column names; an empty cell is nothing that can be measured.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<std::optional<double>>> rows;

  std::string csv() const;
  /// {"rows": [{column: value}]}; null for an empty cell.
  std::string json() const;
};

/// A model with a performance of it.
struct AnimatedModel {
  MorphableModel model;
  WeightTrack performance;
  /// The model's vertex of each of iBUG's landmarks that it has.
  std::vector<std::pair<int, VertexIndex>> landmarks = {};
};

/// Pictures over time, each drawn when it is written.
struct Pictures {
  int count = 0;
  std::function<Image(int)> draw;  ///< may be called from several threads
};

/// Landmarks, and what was noticed while reading them.
struct LandmarksRead {
  LandmarkTrack track;                             ///< with times
  std::vector<std::filesystem::path> images = {};  ///< that each frame shows (F), or none
  /// What was noticed in each frame (F, "" for nothing), or none.
  std::vector<std::string> frame_notes = {};
  std::vector<std::filesystem::path> files = {};
  std::vector<std::string> notes = {};
};

/// A morphable model and where it came from.
struct ModelRead {
  MorphableModel model;
  std::filesystem::path path;  ///< empty for one that was made
};

struct Invocation;

/// A run that wrote something, ready to be made again.
struct RunRead {
  RunRecord record;
  std::shared_ptr<const Invocation> invocation;  ///< its inputs, read, and its parameters
};

/// A page for a browser that needs nothing but itself.
struct Page {
  std::string html;
};

/// One value of the kind at the same place in DataKind.
using Data = std::variant<SequenceRead, BlendshapeModel, Components, RegionData, FieldSequence,
                          Table, AnimatedModel, Image, LandmarksRead, ModelRead, FittedCoefficients,
                          Pictures, RegionView, RunRead, Page>;

/// A value and what it is called in messages and output names.
struct NamedData {
  std::string name;
  Data data;
};

}  // namespace mimetra
