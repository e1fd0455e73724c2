#include "plugins/meshlab/filter_mimetra.h"

#include <map>

#include "plugins/meshlab/layers.h"

using namespace mimetra_meshlab;

namespace {

/// Maximum number of rows: MeshLab's dialogs do not scroll. The rest are further options.
constexpr int kMostRows = 8;

/// Rows besides inputs, outputs and parameters, whose names are in small letters.
constexpr char kField[] = "Field";
constexpr char kManifest[] = "Manifest";

constexpr int kQualityMask = MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR;
constexpr int kRegionMask =
    kQualityMask | MeshModel::MM_VERTFLAGSELECT | MeshModel::MM_FACEFLAGSELECT;

void add_geodesic_rows(const mimetra_operation& operation, RichParameterList& rows) {
  rows.addParam(RichString("source", "", "Source",
                           "vertices to measure from, 0-based, as in 3,17; empty for the "
                           "selected vertices"));
  rows.addParam(RichEnum("quality", 0, {"support", "distance"}, "Quality",
                         "what becomes the vertex quality"));
  add_own_parameters(operation, kMostRows, rows);
}

void add_regions_rows(const mimetra_operation& operation, RichParameterList& rows) {
  add_input(operation, "sequence", "the visible layers", rows);
  add_parameters(operation, {"k", "radius", "region", "coverage"}, rows);
  add_further_options(operation, rows);
}

void add_transfer_rows(const mimetra_operation& operation, RichParameterList& rows) {
  add_input(operation, "source", "the visible layers but the target", rows);
  add_input(operation, "target", "the current layer", rows);
  add_parameters(operation, {"k", "radius", "coverage", "full", "space", "source-rest"}, rows);
  add_further_options(operation, rows);
}

/// Inputs that layers can provide.
const mimetra_port* frames_input(const mimetra_operation& operation) {
  return needed_input(operation, MIMETRA_SEQUENCE);
}
const mimetra_port* mesh_input(const mimetra_operation& operation) {
  return needed_input(operation, MIMETRA_MODEL);
}

bool makes(const mimetra_operation& operation, mimetra_kind kind) {
  for (auto output = operation.outputs; *output; ++output) {
    if (is_needed(**output) && (*output)->kind == kind) return true;
  }
  return false;
}

/// False if the operation makes a model, because layers have no expressions.
bool begins_with_mesh(const mimetra_operation& operation) {
  const mimetra_port* first = *operation.inputs;
  return first && !makes(operation, MIMETRA_MODEL) &&
         (first == frames_input(operation) || first == mesh_input(operation));
}

/// True for an operation that makes a sequence for the fields on it.
bool makes_fields(const mimetra_operation& operation) {
  for (auto output = operation.outputs; *output; ++output) {
    if (is_needed(**output) && has_fields(**output)) return true;
  }
  return false;
}

void add_rows_of_layers(const mimetra_operation& operation, RichParameterList& rows) {
  const mimetra_port* mesh = mesh_input(operation);
  for (auto input = operation.inputs; *input; ++input) {
    if (!is_needed(**input)) continue;
    std::string instead;
    if (*input == mesh) instead = "the current layer";
    if (*input == frames_input(operation)) {
      instead = mesh ? "the visible layers but the current one" : "the visible layers";
    }
    add_input(operation, (*input)->name, instead, rows);
  }
  add_files(operation, rows);
  if (makes_fields(operation)) {
    rows.addParam(RichString(kField, "", kField,
                             "name of the field that becomes the vertex quality; empty for the "
                             "first"));
  }
  add_own_parameters(operation, kMostRows, rows);
  rows.addParam(RichString(kManifest, "", kManifest,
                           "file to write what ran into: options, inputs and report; may be "
                           "empty"));
  add_further_options(operation, rows);
}

QString info_of(const mimetra_operation& operation) {
  QString info = QString::fromUtf8(operation.summary) + '.';
  const mimetra_port* mesh = mesh_input(operation);
  if (frames_input(operation)) {
    info += QString(
                " The frames are the %1visible layers in their order, which must have the same "
                "faces, or a sequence of files.")
                .arg(mesh ? "other " : "");
  }
  if (mesh) info += " The " + QString(mesh->name) + " is the current layer, or a model of files.";
  if (makes_fields(operation)) {
    info += " A field becomes the vertex quality.";
  } else if (makes(operation, MIMETRA_SEQUENCE)) {
    info += " Each frame made is a new, hidden layer.";
  }
  return info;
}

MeshModel& current_layer(MeshDocument& document) {
  MeshModel* layer = document.mm();
  if (!layer) throw Failure("there is no layer; open a mesh");
  vcg::tri::Allocator<CMeshO>::CompactEveryVector(layer->cm);
  return *layer;
}

std::string name_of(const MeshModel& layer) {
  return layer.label().toStdString();
}

/// Selected vertices in the format of the operation.
std::string selected_vertices(const MeshModel& layer) {
  std::string list;
  for (std::size_t i = 0; i < layer.cm.vert.size(); ++i) {
    if (layer.cm.vert[i].IsS()) list += (list.empty() ? "" : ",") + std::to_string(i);
  }
  if (list.empty()) {
    throw Failure("layer '" + name_of(layer) +
                  "' has no selected vertices; select some, or name them as the source");
  }
  return list;
}

/// "mesh 0007" for mesh.ply, since MeshLab hides the part after the point.
std::string numbered(const std::string& name, std::int64_t index) {
  const QString base = QFileInfo(QString::fromStdString(name)).completeBaseName();
  return QString("%1 %2").arg(base).arg(index, 4, 10, QChar('0')).toStdString();
}

void log_line(std::int32_t level, const char* text, void* filter) {
  static_cast<FilterMimetra*>(filter)->Log(
      level == MIMETRA_WARNING ? GLLogStream::WARNING : GLLogStream::FILTER, std::string(text));
}

}  // namespace

FilterMimetra::FilterMimetra() {
  try {
    toolkit_ = std::make_unique<Toolkit>(log_line, this);
  } catch (const Failure& failure) {
    qWarning("mimetra: %s", failure.what());
    return;
  }
  for (const mimetra_operation* operation : toolkit_->operations()) {
    if (!begins_with_mesh(*operation)) continue;
    typeList << static_cast<FilterIDType>(filters_.size());
    filters_.push_back(filter_of(*operation));
    actionList << new QAction(filters_.back().name, this);
  }
}

FilterMimetra::Filter FilterMimetra::filter_of(const mimetra_operation& operation) {
  static const std::map<std::string, Filter> own = {
      {"geodesic",
       {"Geodesic Support Map", nullptr,
        "Distances along the surface of the current layer from its selected vertices, or the "
        "support map around them (0 near, 1 far), as vertex quality. Vertices that are not "
        "connected with the selected ones get the support 1 and the distance -1.",
        Quality | VertexColoring, kQualityMask, SINGLE_MESH, add_geodesic_rows,
        &FilterMimetra::run_geodesic}},
      {"regions",
       {"Regions of Interest", nullptr,
        "The regions of a moving mesh that move by themselves: sparse localized deformation "
        "components, and the discs around their centres. The frames are the visible layers in "
        "their order, which must have the same faces, or a sequence of files. Each vertex gets "
        "the index of its strongest region as quality (-1 outside) and a colour; the regions are "
        "selected.",
        Quality | VertexColoring, kRegionMask, VARIABLE, add_regions_rows,
        &FilterMimetra::run_regions}},
      {"transfer",
       {"Region Transfer", nullptr,
        "Moves the current layer, or a model of files, as a moving mesh with the same faces "
        "moves. The source's frames are the other visible layers in their order, or a sequence of "
        "files. Each frame of the result is a new, hidden layer, with the regions as in Regions of "
        "Interest.",
        Layer, MeshModel::MM_NONE, VARIABLE, add_transfer_rows, &FilterMimetra::run_transfer}}};
  const auto found = own.find(operation.name);
  if (found == own.end()) return filter_of_layers(operation);
  Filter filter = found->second;
  filter.operation = &operation;
  return filter;
}

FilterMimetra::Filter FilterMimetra::filter_of_layers(const mimetra_operation& operation) {
  int filter_class = Measure;
  int changes = MeshModel::MM_NONE;
  if (makes(operation, MIMETRA_SEQUENCE)) filter_class = Layer;
  if (makes_fields(operation)) {
    filter_class = Quality | VertexColoring;
    changes = kQualityMask;
  }
  if (makes(operation, MIMETRA_REGIONS)) {
    filter_class = Quality | VertexColoring;
    changes = kRegionMask;
  }
  return {"mimetra " + label_of(operation.name),
          &operation,
          info_of(operation),
          filter_class,
          changes,
          VARIABLE,
          add_rows_of_layers,
          &FilterMimetra::run_on_layers};
}

QString FilterMimetra::pluginName() const {
  return "FilterMimetra";
}

QString FilterMimetra::filterName(FilterIDType id) const {
  return filters_.at(id).name;
}

QString FilterMimetra::filterInfo(FilterIDType id) const {
  return filters_.at(id).info;
}

MeshFilterInterface::FilterClass FilterMimetra::getClass(QAction* action) {
  return static_cast<FilterClass>(filter(action).filter_class);
}

int FilterMimetra::getPreConditions(QAction*) const {
  return MeshModel::MM_FACENUMBER;
}

int FilterMimetra::postCondition(QAction* action) const {
  return filter(action).changes;
}

MeshFilterInterface::FILTER_ARITY FilterMimetra::filterArity(QAction* action) const {
  return filter(action).arity;
}

void FilterMimetra::initParameterSet(QAction* action, MeshDocument&, RichParameterList& rows) {
  filter(action).add_rows(*filter(action).operation, rows);
}

bool FilterMimetra::applyFilter(QAction* action, MeshDocument& document,
                                const RichParameterList& rows, vcg::CallBackPos* progress) {
  progress_ = progress;
  try {
    (this->*filter(action).run)(*filter(action).operation, document, rows);
    return true;
  } catch (const std::exception& error) {
    // MeshLab shows the message as HTML, meshlabserver shows the log.
    errorMessage = QString::fromUtf8(error.what()).toHtmlEscaped();
    Log(GLLogStream::WARNING, std::string(error.what()));
    return false;
  }
}

void FilterMimetra::run_geodesic(const mimetra_operation& operation, MeshDocument& document,
                                 const RichParameterList& rows) {
  MeshModel& layer = current_layer(document);
  Call call(*toolkit_, operation.name);
  call.give("mesh", toolkit_->sequence(name_of(layer), frames_of({&layer})));
  const std::string source = text_of(rows, "source");
  call.set("source", source.empty() ? selected_vertices(layer) : source);
  run(call, request_of(operation, rows));
  const char* field = rows.getEnum("quality") == 1 ? "distance" : "support";
  show_values(layer, toolkit_->field(call.output("out"), field));
}

void FilterMimetra::run_regions(const mimetra_operation& operation, MeshDocument& document,
                                const RichParameterList& rows) {
  std::vector<MeshModel*> shown = {&current_layer(document)};
  const bool from_layers = text_of(rows, "sequence").empty();
  if (from_layers) shown = visible_layers(document);
  const Request request = request_of(operation, rows);
  const Data sequence = sequence_of(rows, "sequence", request.reading, shown);
  if (!from_layers) {
    check_same_faces(toolkit_->frames_of(sequence), toolkit_->name_of(sequence), frames_of(shown),
                     "the current layer");
  }
  Call call(*toolkit_, operation.name);
  call.give("sequence", sequence);
  run(call, request);
  const std::vector<double> region = toolkit_->field(call.output("out"), "region");
  for (MeshModel* layer : shown) show_regions(*layer, region);
  save_outputs(call, request);
}

void FilterMimetra::run_transfer(const mimetra_operation& operation, MeshDocument& document,
                                 const RichParameterList& rows) {
  MeshModel& current = current_layer(document);
  const bool to_layer = text_of(rows, "target").empty();
  const Request request = request_of(operation, rows);
  Call call(*toolkit_, operation.name);
  give_inputs(call, operation, document, rows, request.reading);
  if (!rows.getBool("full")) call.want("regions-out");
  run(call, request);

  const Data result = call.output("out");
  const std::string name = to_layer ? name_of(current) : toolkit_->name_of(result);
  const std::vector<MeshModel*> layers =
      add_layers(document, name, toolkit_->frames_of(result), to_layer ? &current : nullptr);
  if (const Data regions = call.output("regions-out")) {
    const std::vector<double> region = toolkit_->field(regions, "region");
    for (MeshModel* layer : layers) show_regions(*layer, region);
  }
  save_outputs(call, request);
}

void FilterMimetra::run_on_layers(const mimetra_operation& operation, MeshDocument& document,
                                  const RichParameterList& rows) {
  const Request request = request_of(operation, rows);
  Call call(*toolkit_, operation.name);
  const std::vector<MeshModel*> given =
      give_inputs(call, operation, document, rows, request.reading);
  const std::string manifest = text_of(rows, kManifest);
  if (!manifest.empty()) call.write_manifest(manifest);
  run(call, request);
  for (auto output = operation.outputs; *output; ++output) {
    if (!is_needed(**output) || !is_shown(**output)) continue;
    const Data made = call.output((*output)->name);
    if (has_fields(**output)) {
      show_fields(document, operation.name, made, given, text_of(rows, kField));
    } else if ((*output)->kind == MIMETRA_SEQUENCE) {
      const Frames frames = toolkit_->frames_of(made);
      const bool on_given = !given.empty() && have_same_faces(frames, frames_of({given.front()}));
      add_layers(document, operation.name, frames, on_given ? given.front() : nullptr);
    } else if ((*output)->kind == MIMETRA_REGIONS) {
      const std::vector<double> region = toolkit_->field(made, "region");
      for (MeshModel* layer : given) show_regions(*layer, region);
    } else {
      for (const std::string& line : toolkit_->lines_of(made)) Log(GLLogStream::FILTER, line);
    }
  }
  save_outputs(call, request);
}

std::vector<MeshModel*> FilterMimetra::give_inputs(Call& call, const mimetra_operation& operation,
                                                   MeshDocument& document,
                                                   const RichParameterList& rows,
                                                   const std::vector<std::string>& reading) const {
  MeshModel& current = current_layer(document);
  const mimetra_port* mesh = mesh_input(operation);
  const mimetra_port* frames = frames_input(operation);
  const bool takes_current = mesh && text_of(rows, mesh->name).empty();
  if (takes_current) {
    call.give(mesh->name, toolkit_->mesh(name_of(current), frames_of({&current})));
  }
  std::vector<MeshModel*> given;
  if (takes_current && !frames) given = {&current};
  if (frames && text_of(rows, frames->name).empty()) {
    given = visible_layers(document, takes_current ? &current : nullptr);
  }
  if (frames) call.give(frames->name, sequence_of(rows, frames->name, reading, given));
  for (auto input = operation.inputs; *input; ++input) {
    const bool is_given = *input == frames || (*input == mesh && takes_current);
    if (is_needed(**input) && !is_given) call.read((*input)->name, text_of(rows, (*input)->name));
  }
  return given;
}

Data FilterMimetra::sequence_of(const RichParameterList& rows, const char* input,
                                const std::vector<std::string>& reading,
                                const std::vector<MeshModel*>& layers) const {
  const std::string path = text_of(rows, input);
  if (!path.empty()) return toolkit_->load_sequence(path, reading);
  if (!reading.empty()) {
    throw Failure("further options: " + reading.front() + " is about files; name them as the " +
                  input);
  }
  if (layers.empty()) {
    throw Failure(std::string("there are no frames: show the layers that are the ") + input +
                  ", or name its files");
  }
  return toolkit_->sequence("layers", frames_of(layers));
}

std::vector<MeshModel*> FilterMimetra::add_layers(MeshDocument& document, const std::string& name,
                                                  const Frames& frames, MeshModel* base) {
  std::vector<MeshModel*> layers;
  for (std::int64_t i = 0; i < frames.count; ++i) {
    base = &add_layer(document, numbered(name, i), frames, i, base);
    layers.push_back(base);
  }
  Log(GLLogStream::FILTER, std::to_string(frames.count) + " frames are new, hidden layers");
  return layers;
}

void FilterMimetra::show_fields(MeshDocument& document, const std::string& name, const Data& fields,
                                const std::vector<MeshModel*>& given, const std::string& field) {
  const std::vector<std::string> names = toolkit_->vertex_fields(fields);
  if (field.empty() && names.empty()) throw Failure(name + ": made no numbers on vertices");
  const std::string shown = field.empty() ? names.front() : field;
  if (std::find(names.begin(), names.end(), shown) == names.end()) {
    std::string known;
    for (const std::string& each : names) known += (known.empty() ? "" : ", ") + each;
    throw Failure("field: expected one of " + known + ", found '" + shown + "'");
  }
  const std::vector<double> values = toolkit_->field(fields, shown.c_str());
  const Frames frames = toolkit_->frames_of(fields);
  const Frames before = given.empty() ? Frames() : frames_of(given);
  const bool same_faces = have_same_faces(frames, before);
  std::vector<MeshModel*> layers = given;
  if (!same_faces || frames.positions != before.positions) {
    layers = add_layers(document, name, frames, same_faces ? given.front() : nullptr);
  }
  for (MeshModel* layer : layers) show_values(*layer, values);
  Log(GLLogStream::FILTER, "the vertex quality is " + shown);
}

void FilterMimetra::run(Call& call, const Request& request) {
  for (const Setting& setting : request.parameters) call.set(setting.name.c_str(), setting.text);
  for (const Setting& input : request.inputs) call.read(input.name.c_str(), input.text);
  for (const Setting& output : request.outputs) {
    if (QFileInfo::exists(QString::fromStdString(output.text))) {
      throw Failure(output.text + ": exists; choose another name, or remove it");
    }
    call.want(output.name.c_str());
  }
  call.run(
      [](double share, void* self) -> std::int32_t {
        auto* progress = static_cast<FilterMimetra*>(self)->progress_;
        return !progress || progress(static_cast<int>(100 * share), "mimetra");
      },
      this);
  const QStringList lines = QString::fromStdString(call.summary()).split('\n', Qt::SkipEmptyParts);
  for (const QString& line : lines) Log(GLLogStream::FILTER, line.toStdString());
}

void FilterMimetra::save_outputs(const Call& call, const Request& request) const {
  for (const Setting& output : request.outputs) {
    toolkit_->save(call.output(output.name.c_str()), output.text);
  }
}

MESHLAB_PLUGIN_NAME_EXPORTER(FilterMimetra)
