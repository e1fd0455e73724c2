#include "toolkit/vtk/vtk_formats.h"

#include <algorithm>

#include "toolkit/io/file_parameters.h"
#include "toolkit/io/format.h"
#include "toolkit/io/frame_times.h"
#include "toolkit/io/regions_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/colors.h"
#include "toolkit/vtk/vtp_series.h"

namespace mimetra {

namespace {

/// Throws MismatchError if the target would hold only the first of several frames.
void check_frame_count(const FrameSource& frames, const std::filesystem::path& target) {
  if (frames.frames() == 1 || lower_extension(target) != ".vtp") return;
  throw MismatchError(target.string() + ": holds one frame, and the sequence has " +
                      std::to_string(frames.frames()) +
                      "; write a .pvd, or take one by option 'frames'");
}

Format::Paths write_sequence_data(const Data& data, const std::filesystem::path& target,
                                  const WriteOptions& options, const Context& context) {
  FieldSequence sequence = std::get<FieldSequence>(data);
  check_frame_count(*sequence.frames, target);
  show_displacement(sequence);
  return write_vtp_series(sequence, target, options, context);
}

ReadValue read_sequence_data(const std::string& text, const ReadOptions& options,
                             const Context& context) {
  std::vector<std::string> notes;
  const Context noting =
      context.with_notes([&](const Note& note) { notes.push_back(text + ": " + note.text); });
  FieldSequence read = open_vtp_series(text, options, noting);
  // The steps between selected frames may differ.
  const std::string odd = options.frames ? "" : note_on_steps(read.frames->known_times());
  if (!odd.empty()) noting.note(odd);
  return {{text, std::move(read)}, vtp_series_files(text), std::move(notes)};
}

Format::Paths write_region_data(const Data& data, const std::filesystem::path& target,
                                const WriteOptions& options, const Context& context) {
  FieldSequence shown = shown_regions(data, target);
  const auto region = std::ranges::find(shown.fields, "region", &Field::name);
  if (region != shown.fields.end() && region->values.rows() == shown.frames->vertices()) {
    shown.fields.push_back(region_color_field(*region, shown.frames->connectivity()));
  }
  return write_vtp_series(shown, target, options, context);
}

ReadValue read_region_data(const std::string& text, const ReadOptions& options, const Context&) {
  return {{text, RegionData{region_of_mask(text, read_vtp_field(text, "roi"),
                                           find_vtp_field(text, "weight"), options.vertices,
                                           *options.triangles),
                            {}}},
          {text}};
}

}  // namespace

void add_vtp(OperationTable& table) {
  const std::vector<Parameter> reading = reading_parameters({"frames", "fps"});
  const std::vector<Parameter> writing = writing_parameters({"compress"});
  Format series{.name = "ParaView time series",
                .kind = DataKind::sequence,
                .extensions = {".pvd"},
                .reading = reading,
                .read = read_sequence_data,
                .writing = writing,
                .write = write_sequence_data,
                .fields = true,
                .displacements = true,
                .holds = [](const WriteOptions&) {
                  return HeldParts{.polygons = true, .exact_positions = false};
                }};
  table.add(series);
  series.name = "VTK mesh, or numbered ones";
  series.extensions = {".vtp"};
  series.numbered = true;
  table.add(series);
  table.add(Format{.name = "VTK grid of polygons, or legacy VTK mesh",
                   .kind = DataKind::sequence,
                   .extensions = {".vtu", ".vtk"},
                   .reading = reading,
                   .read = read_sequence_data,
                   .numbered = true,
                   .fields = true});
  table.add(Format{.name = "list of .vtp, .vtu or .vtk files",
                   .kind = DataKind::sequence,
                   .extensions = {".series"},
                   .reading = reading,
                   .read = read_sequence_data,
                   .fields = true});
  table.add(Format{.name = "ParaView time series with region fields",
                   .kind = DataKind::regions,
                   .extensions = {".pvd"},
                   .writing = writing,
                   .write = write_region_data});
  table.add(Format{.name = "VTK mesh with region fields",
                   .kind = DataKind::regions,
                   .extensions = {".vtp"},
                   .read = read_region_data,
                   .writing = writing,
                   .write = write_region_data});
}

void add_vtk(OperationTable& table) {
  add_vtp(table);
  table.add(Format{.name = "script for ParaView",
                   .kind = DataKind::document,
                   .extensions = {".py"},
                   .write = write_document});
}

}  // namespace mimetra
