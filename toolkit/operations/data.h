#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <mimetra/io/sequence_file.h>
#include <mimetra/io/weight_track.h>
#include <mimetra/mesh/fields.h>
#include <mimetra/model/morphable_model.h>
#include <mimetra/regions/regions.h>
#include <mimetra/splocs/decomposition.h>

namespace mimetra {

/// What goes into operations and comes out of them.
enum class DataKind { sequence, model, components, regions, fields, table, animated_model };

/// Regions and the sequence they are shown on (empty for regions that were read).
struct RegionData {
  Regions regions;
  FieldSequence fields;
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
};

/// One value of the kind at the same place in DataKind.
using Data = std::variant<SequenceRead, BlendshapeModel, Components, RegionData, FieldSequence,
                          Table, AnimatedModel>;

/// A value and what it is called in messages and output names.
struct NamedData {
  std::string name;
  Data data;
};

}  // namespace mimetra
