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
#include "toolkit/io/weight_track.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/model/blendshape_model.h"
#include "toolkit/model/landmark_track.h"
#include "toolkit/operations/image.h"
#include "toolkit/regions/regions.h"
#include "toolkit/splocs/decomposition.h"

namespace mimetra {

/// What goes into operations and comes out of them.
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

/// "sequence", as in the JSON of the operations table.
std::string_view kind_name(DataKind kind);

/// Regions and the sequence they are shown on (empty for regions that were read).
struct RegionData {
  Regions regions;
  FieldSequence fields;
  /// Faces of those that were made for a mesh without a sequence, or null.
  std::shared_ptr<const Connectivity> faces = {};
};

/// Rows of numbers under column names; an empty cell is nothing that can be measured.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<std::optional<double>>> rows;
  /// One more column, the last, that holds words: its name, or none, and a word for each row, ""
  /// for nothing.
  std::string word_column = {};
  std::vector<std::string> words = {};
  /// What a picture of the table shows; by default all columns against the first.
  struct Picture {
    std::string x, y;  ///< columns
    std::string title, x_label, y_label;
    std::string without_word = {};  ///< name of the line of rows without a word
  };
  std::optional<Picture> picture = {};

  std::string csv() const;
  /// {"rows": [{column: value}]}; null for an empty cell.
  std::string json() const;
};

/// A model: one person, or with identities; perhaps with a performance of it.
struct ModelData {
  MorphableModel model;
  WeightTrack performance = {};
  /// The model's vertex of each of iBUG's landmarks that it has.
  std::vector<std::pair<int, VertexIndex>> landmarks = {};
};

/// One picture, or several over time, each drawn when it is needed.
struct Pictures {
  int count = 0;
  std::function<Image(int)> draw;  ///< may be called from several threads
  Eigen::VectorXd times = {};      ///< seconds (count), or none
  /// A video whose sound belongs to them, at these times, or none.
  std::filesystem::path sound = {};

  static Pictures of(Image image);
};

/// Text that stands for itself: a page for a browser, a script.
struct Document {
  std::string text;
};

/// One value of the kind at the same place in DataKind.
using Data = std::variant<FieldSequence, ModelData, Components, RegionData, Table, LandmarkTrack,
                          FittedCoefficients, Pictures, Document>;

DataKind kind_of(const Data& data);

struct RunRead;

/// What was noticed where a value was read or made, beside it.
struct Origin {
  /// A model drives the sequence: its rest pose is its neutral.
  bool model_driven = false;
  /// Where a model was read; empty for one that was made.
  std::filesystem::path path = {};
  /// What the frames of landmarks show (F images), or null.
  std::shared_ptr<const ImageSequence> images = {};
  /// What was noticed in each frame of landmarks (F, "" for nothing), or none.
  std::vector<std::string> frame_notes = {};
  /// What was noticed while it was read, which was said by then.
  std::vector<std::string> notes = {};
  /// The run that wrote a manifest.
  std::shared_ptr<const RunRead> run = {};
};

/// A value and what it is called in messages and output names.
struct NamedData {
  std::string name;
  Data data;
  Origin origin = {};
  /// Text that is written beside it, by the end of its name: ".correspondence.json" becomes
  /// NAME.correspondence.json beside a file NAME.EXT, and correspondence.json in a folder.
  std::map<std::string, std::string> beside = {};
  /// Fields of a sequence that nobody asked for: written where the format holds fields, and left
  /// out without a word elsewhere.
  std::vector<Field> more_fields = {};
};

/// The one person, or the average, of a value that is a model.
const BlendshapeModel& person_of(const NamedData& value);

}  // namespace mimetra
