#include "toolkit/operations/weight_tables.h"

#include <algorithm>
#include <stdexcept>

#include "toolkit/io/live_link.h"
#include "toolkit/io/time_columns.h"
#include "toolkit/io/weight_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/model/animation.h"

namespace mimetra {
namespace {

constexpr const char* kTimeColumn = "time";
constexpr const char* kLiveLink = ".livelink.csv";

using Paths = Format::Paths;

/// Whether a path is in Live Link Face's format.
bool is_live_link(const std::filesystem::path& path) {
  return lower_case(path.filename().string()).ends_with(kLiveLink);
}

ReadValue read_weight_table(const std::string& text, const ReadOptions&, const Context&) {
  const WeightTrack track = read_weights(text);
  ReadValue read{{text, weight_table(track)}, {text}};
  for (const std::string& note : track.notes) read.notes.push_back(text + ": " + note);
  if (track.times.size() == 0 && track.step != 1) {
    read.notes.push_back(text + ": rows are " + readable(track.step) +
                         " frames apart; where option 'fps' is given, it counts rows");
  }
  return read;
}

/// Returns the weights of a sequence that a model's weights drive.
WeightTrack track_of(const FieldSequence& sequence, const std::filesystem::path& target) {
  const auto* animation = dynamic_cast<const Animation*>(sequence.frames.get());
  if (!animation) {
    throw MismatchError(target.string() + ": holds weights, and none drive the sequence");
  }
  return {animation->model().expressions().names, animation->weights(), animation->known_times()};
}

WeightTrack track_of(const Data& data, const std::filesystem::path& target) {
  if (const auto* table = std::get_if<Table>(&data)) return track_of(*table);
  return track_of(std::get<FieldSequence>(data), target);
}

LiveLinkText live_link_of(const Data& data, const std::filesystem::path& target) {
  try {
    return live_link_csv(track_of(data, target));
  } catch (const MismatchError& error) {
    throw MismatchError(target.string() + ": " + error.what());
  }
}

Paths write_live_link(const Data& data, const std::filesystem::path& target,
                      const WriteOptions& options, const Context&) {
  return write_text(target, options, live_link_of(data, target).text);
}

std::vector<std::string> live_link_losses(const Data& data, const std::filesystem::path& target) {
  std::vector<std::string> notes = live_link_of(data, target).notes;
  for (std::string& note : notes) note = target.string() + ": " + note;
  return notes;
}

/// Refuses expressions with the name of a column of times or of frame numbers, which reading would
/// mistake for such a column.
void check_names(const Table& weights, bool timed, const std::filesystem::path& target) {
  const auto other =
      std::find_if(weights.columns.begin() + (timed ? 1 : 0), weights.columns.end(), is_no_weight);
  if (other == weights.columns.end()) return;
  throw MismatchError(target.string() + ": an expression is called '" + *other +
                      "', as a column that holds no weights is; rename the expression");
}

/// Writes a table, or a sequence's weights as a table.
template <std::string (Table::*Text)() const>
Paths write_table(const Data& data, const std::filesystem::path& target,
                  const WriteOptions& options, const Context&) {
  const auto* given = std::get_if<Table>(&data);
  const Table table = given ? *given : weight_table(track_of(data, target));
  const bool timed = !table.columns.empty() && table.columns.front() == kTimeColumn;
  if (timed || !given) check_names(table, timed, target);
  return write_text(target, options, (table.*Text)());
}

}  // namespace

Table weight_table(const WeightTrack& track) {
  Table table;
  const bool timed = track.times.size() > 0;
  if (timed) table.columns = {kTimeColumn};
  table.columns.insert(table.columns.end(), track.names.begin(), track.names.end());
  for (Eigen::Index f = 0; f < track.weights.rows(); ++f) {
    auto& row = table.rows.emplace_back();
    if (timed) row.push_back(track.times[f]);
    for (const double weight : track.weights.row(f)) row.push_back(weight);
  }
  return table;
}

WeightTrack track_of(const Table& table) {
  const auto time = std::ranges::find(table.columns, kTimeColumn) - table.columns.begin();
  const auto columns = std::ssize(table.columns);
  const bool timed = time < columns;
  WeightTrack track;
  for (const std::string& column : table.columns) {
    if (column != kTimeColumn) track.names.push_back(column);
  }
  if (track.names.empty() || table.rows.empty()) {
    throw MismatchError("weights: " + std::to_string(table.rows.size()) + " rows of " +
                        std::to_string(track.names.size()) + " weights, expected one at least");
  }
  const auto frames = static_cast<Eigen::Index>(table.rows.size());
  track.weights.resize(frames, static_cast<Eigen::Index>(track.names.size()));
  if (timed) track.times.resize(frames);
  for (Eigen::Index f = 0; f < frames; ++f) {
    const auto& row = table.rows[static_cast<std::size_t>(f)];
    Eigen::Index next = 0;
    for (std::ptrdiff_t c = 0; c < columns; ++c) {
      const auto at = static_cast<std::size_t>(c);
      if (at >= row.size() || !row[at]) {
        throw MismatchError("weights: row " + std::to_string(f) + " has nothing in column '" +
                            table.columns[at] + "', expected a number");
      }
      (c == time ? track.times[f] : track.weights(f, next++)) = *row[at];
    }
    if (timed && f > 0 && !(track.times[f] > track.times[f - 1])) {
      throw MismatchError("weights: the time of row " + std::to_string(f) +
                          " is not later than that of the one before");
    }
  }
  return track;
}

bool is_weight_file(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".csv" || extension == ".json";
}

void check_live_link(const Invocation& invocation, const std::string& output,
                     const std::vector<std::string>& expressions) {
  const auto wanted = invocation.wanted.find(output);
  if (wanted == invocation.wanted.end() || has_live_link_names(expressions)) return;
  for (const std::filesystem::path& path : wanted->second) {
    if (!is_live_link(path)) continue;
    throw UsageError(path.string() +
                     ": Live Link's columns are ARKit's expressions, and none of these is one: " +
                     listed(expressions) + "; write .csv or .json");
  }
}

void check_no_live_link(const Invocation& invocation, const std::string& output) {
  for (const std::filesystem::path& path : invocation.wanted.at(output)) {
    if (!is_live_link(path)) continue;
    throw UsageError(path.string() +
                     ": Live Link has one weight for each expression, and --per-region one for "
                     "each region; write .csv or .json");
  }
}

void add_weight_formats(OperationTable& table) {
  table.add(Format{.name = "comma-separated values",
                   .kind = DataKind::table,
                   .extensions = {".csv"},
                   .read = read_weight_table,
                   .write = write_table<&Table::csv>});
  table.add(Format{.name = "rows as JSON",
                   .kind = DataKind::table,
                   .extensions = {".json"},
                   .read = read_weight_table,
                   .write = write_table<&Table::json>});
  table.add(Format{.name = "weights as Live Link Face",
                   .kind = DataKind::table,
                   .extensions = {kLiveLink},
                   .write = write_live_link,
                   .weights = true,
                   .losses = live_link_losses});
  table.add(Format{.name = "weights of a model, comma-separated",
                   .kind = DataKind::sequence,
                   .extensions = {".csv"},
                   .write = write_table<&Table::csv>,
                   .weights = true});
  table.add(Format{.name = "weights of a model as JSON",
                   .kind = DataKind::sequence,
                   .extensions = {".json"},
                   .write = write_table<&Table::json>,
                   .weights = true});
  table.add(Format{.name = "weights of a model as Live Link Face",
                   .kind = DataKind::sequence,
                   .extensions = {kLiveLink},
                   .write = write_live_link,
                   .weights = true,
                   .losses = live_link_losses});
  table.add(Format{.name = "map of weights between rigs",
                   .kind = DataKind::document,
                   .extensions = {".json"},
                   .write = write_document});
  table.add(Format{.name = "matrix of weights between rigs",
                   .kind = DataKind::document,
                   .extensions = {".csv"},
                   .write = write_document});
}

}  // namespace mimetra
