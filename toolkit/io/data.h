#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "toolkit/io/fit_file.h"
#include "toolkit/io/image.h"
#include "toolkit/io/weight_track.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/model/blendshape_model.h"
#include "toolkit/model/landmark_track.h"
#include "toolkit/regions/regions.h"
#include "toolkit/splocs/decomposition.h"

namespace mimetra {

/// Kind of a value that operations take or return.
enum class DataKind {
  sequence,
  model,
  components,
  regions,
  table,
  landmarks,
  fit,
  pictures,
  document
};

/// Name of a kind in the JSON of the operations table, such as "sequence".
std::string_view kind_name(DataKind kind);

/// Regions and the sequence on which they are shown (empty for regions that were read).
struct RegionData {
  Regions regions;
  FieldSequence fields;
  /// Faces of the mesh, for regions that were made without a sequence; or null.
  std::shared_ptr<const Connectivity> faces = {};
};

/// Rows of numbers under column names. An empty cell has no measurable value.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<std::optional<double>>> rows;
  /// Name of an additional last column of words; empty if there is none. Each row has a word, or
  /// "".
  std::string word_column = {};
  std::vector<std::string> words = {};
  /// Contents of a plot of the table. Default: all columns against the first.
  struct Picture {
    std::string x, y;  ///< names of columns
    std::string title, x_label, y_label;
    std::string without_word = {};  ///< label of the line of rows without a word
  };
  std::optional<Picture> picture = {};

  std::string csv() const;
  /// {"rows": [{column: value}]}; null for an empty cell.
  std::string json() const;
};

/// A model of one person, or with identities, and possibly a performance of it.
struct ModelData {
  MorphableModel model;
  WeightTrack performance = {};
  /// Number and vertex of each iBUG landmark that the model has.
  std::vector<std::pair<int, VertexIndex>> landmarks = {};
};

/// One picture, or several over time, each drawn on demand.
struct Pictures {
  int count = 0;
  std::function<Image(int)> draw;  ///< safe to call from several threads
  Eigen::VectorXd times = {};      ///< seconds (count), or empty
  /// Video with the sound of the pictures, at these times; or empty.
  std::filesystem::path sound = {};

  static Pictures of(Image image);
};

/// Text for direct use, such as a page for a browser or a script.
struct Document {
  std::string text;
};

/// One value, with the alternatives in the order of DataKind.
using Data = std::variant<FieldSequence, ModelData, Components, RegionData, Table, LandmarkTrack,
                          FittedCoefficients, Pictures, Document>;

DataKind kind_of(const Data& data);

/// The value with all frames in memory, if it is a sequence. Throws as reading the frames.
Data in_memory(Data data, const Context& context = {});

struct RunRead;

/// Facts about the origin of a value.
struct Origin {
  /// A model drives the sequence, so its rest pose is its neutral.
  bool model_driven = false;
  /// Path from which a model was read; empty for a model that was made.
  std::filesystem::path path = {};
  /// Images of the frames of landmarks (F), or null.
  std::shared_ptr<const ImageSequence> images = {};
  /// Note on each frame of landmarks (F, "" for no note), or empty.
  std::vector<std::string> frame_notes = {};
  /// Notes of the reader. They have already been reported.
  std::vector<std::string> notes = {};
  /// The run that a manifest records.
  std::shared_ptr<const RunRead> run = {};
};

/// A value and its name in messages and output names.
struct NamedData {
  std::string name;
  Data data;
  Origin origin = {};
  /// Text files to write beside the value, by the end of their names. ".correspondence.json"
  /// becomes NAME.correspondence.json beside a file NAME.EXT, and correspondence.json in a folder.
  std::map<std::string, std::string> beside = {};
  /// Optional fields of a sequence. Formats with fields write them; other formats drop them
  /// silently.
  std::vector<Field> more_fields = {};
};

/// Returns the one person, or the average, of a model.
const BlendshapeModel& person_of(const NamedData& value);

}  // namespace mimetra
