#include "plugins/meshlab/filter_mimetra.h"

#include <array>
#include <cmath>

#include <vcg/complex/algorithms/update/color.h>

#include "plugins/meshlab/layers.h"

using namespace mimetra_meshlab;

namespace {

/// What MeshLab knows of a filter beside its operation.
struct Description {
  const char* name;
  const char* operation;
  const char* info;
  int filter_class;
  MeshFilterInterface::FILTER_ARITY arity;
};

const std::array<Description, 3> kFilters = {
    {{"Geodesic Support Map", "geodesic",
      "Distances along the surface of the current layer from its selected vertices, or the support "
      "map around them (0 near, 1 far), as vertex quality. Vertices that are not connected with "
      "the selected ones get the support 1 and the distance -1.",
      MeshFilterInterface::Quality | MeshFilterInterface::VertexColoring,
      MeshFilterInterface::SINGLE_MESH},
     {"Regions of Interest", "regions",
      "The regions of a moving mesh that move by themselves: sparse localized deformation "
      "components, and the discs around their centres. The frames are the visible layers in their "
      "order, which must have the same faces, or a sequence of files. Each vertex gets the index "
      "of its strongest region as quality (-1 outside) and a colour; the regions are selected.",
      MeshFilterInterface::Quality | MeshFilterInterface::VertexColoring,
      MeshFilterInterface::VARIABLE},
     {"Region Transfer", "transfer",
      "Moves the current layer, or a model of files, as a moving mesh with the same faces moves. "
      "The source's frames are the other visible layers in their order, or a sequence of files. "
      "Each frame of the result is a new, hidden layer, with the regions as in Regions of "
      "Interest.",
      MeshFilterInterface::Layer, MeshFilterInterface::VARIABLE}}};

MeshModel& current_layer(MeshDocument& document) {
  MeshModel* layer = document.mm();
  if (!layer) throw Failure("there is no layer; open a mesh");
  vcg::tri::Allocator<CMeshO>::CompactEveryVector(layer->cm);
  return *layer;
}

std::string name_of(const MeshModel& layer) {
  return layer.label().toStdString();
}

/// The selected vertices, as the operation takes them.
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

/// "mesh 0007" for mesh.ply: MeshLab does not show what stands after the point.
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
    for (const Description& filter : kFilters) toolkit_->operation(filter.operation);
  } catch (const Failure& failure) {
    qWarning("mimetra: %s", failure.what());
    return;
  }
  typeList = {kGeodesic, kRegions, kTransfer};
  for (const FilterIDType filter : typeList) actionList << new QAction(filterName(filter), this);
}

QString FilterMimetra::pluginName() const {
  return "FilterMimetra";
}

QString FilterMimetra::filterName(FilterIDType filter) const {
  return kFilters.at(filter).name;
}

QString FilterMimetra::filterInfo(FilterIDType filter) const {
  return kFilters.at(filter).info;
}

MeshFilterInterface::FilterClass FilterMimetra::getClass(QAction* action) {
  return static_cast<FilterClass>(kFilters.at(ID(action)).filter_class);
}

int FilterMimetra::getPreConditions(QAction*) const {
  return MeshModel::MM_FACENUMBER;
}

int FilterMimetra::postCondition(QAction* action) const {
  switch (ID(action)) {
    case kGeodesic:
      return MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR;
    case kRegions:
      return MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR | MeshModel::MM_VERTFLAGSELECT |
             MeshModel::MM_FACEFLAGSELECT;
    default:
      return MeshModel::MM_NONE;
  }
}

MeshFilterInterface::FILTER_ARITY FilterMimetra::filterArity(QAction* action) const {
  return kFilters.at(ID(action)).arity;
}

void FilterMimetra::initParameterSet(QAction* action, MeshDocument&, RichParameterList& rows) {
  const FilterIDType filter = ID(action);
  const mimetra_operation& operation = operation_of(filter);
  if (filter == kGeodesic) {
    rows.addParam(RichString("source", "", "Source",
                             "vertices to measure from, 0-based, as in 3,17; empty for the "
                             "selected vertices"));
    rows.addParam(RichEnum("quality", 0, {"support", "distance"}, "Quality",
                           "what becomes the vertex quality"));
    add_all_parameters(operation, rows);
    return;
  }
  if (filter == kRegions) {
    add_input(operation, "sequence", "the visible layers", rows);
    add_parameters(operation, {"k", "radius", "region", "coverage"}, rows);
  } else {
    add_input(operation, "source", "the visible layers but the target", rows);
    add_input(operation, "target", "the current layer", rows);
    add_parameters(operation, {"k", "radius", "coverage", "full", "space", "source-rest"}, rows);
  }
  add_further_options(operation, rows);
}

bool FilterMimetra::applyFilter(QAction* action, MeshDocument& document,
                                const RichParameterList& rows, vcg::CallBackPos* progress) {
  progress_ = progress;
  try {
    switch (ID(action)) {
      case kGeodesic:
        run_geodesic(document, rows);
        break;
      case kRegions:
        run_regions(document, rows);
        break;
      default:
        run_transfer(document, rows);
    }
    return true;
  } catch (const std::exception& error) {
    // MeshLab shows the message, as HTML, and meshlabserver the log.
    errorMessage = QString::fromUtf8(error.what()).toHtmlEscaped();
    Log(GLLogStream::WARNING, std::string(error.what()));
    return false;
  }
}

void FilterMimetra::run_geodesic(MeshDocument& document, const RichParameterList& rows) {
  MeshModel& layer = current_layer(document);
  Call call(*toolkit_, "geodesic");
  call.give("mesh", toolkit_->sequence(name_of(layer), frames_of({&layer})));
  const std::string source = text_of(rows, "source");
  call.set("source", source.empty() ? selected_vertices(layer) : source);
  run(call, request_of(operation_of(kGeodesic), rows));
  const char* field = rows.getEnum("quality") == 1 ? "distance" : "support";
  std::vector<double> values = toolkit_->field(call.output("out"), field);
  // Not reached; MeshLab's colours and histograms need numbers.
  for (double& value : values) value = std::isnan(value) ? -1 : value;
  set_quality(layer, values);
  layer.updateDataMask(MeshModel::MM_VERTCOLOR);
  vcg::tri::UpdateColor<CMeshO>::PerVertexQualityRamp(layer.cm);
}

void FilterMimetra::run_regions(MeshDocument& document, const RichParameterList& rows) {
  std::vector<MeshModel*> shown = {&current_layer(document)};
  const bool from_layers = text_of(rows, "sequence").empty();
  if (from_layers) shown = visible_layers(document);
  const Request request = request_of(operation_of(kRegions), rows);
  const Data sequence = sequence_of(rows, "sequence", request.reading, shown);
  if (!from_layers) {
    check_same_faces(toolkit_->frames_of(sequence), toolkit_->name_of(sequence), frames_of(shown),
                     "the current layer");
  }
  Call call(*toolkit_, "regions");
  call.give("sequence", sequence);
  run(call, request);
  const std::vector<double> region = toolkit_->field(call.output("out"), "region");
  for (MeshModel* layer : shown) show_regions(*layer, region);
  save_outputs(call, request);
}

void FilterMimetra::run_transfer(MeshDocument& document, const RichParameterList& rows) {
  MeshModel& current = current_layer(document);
  Call call(*toolkit_, "transfer");
  const std::string model = text_of(rows, "target");
  const bool to_layer = model.empty();
  if (to_layer) {
    call.give("target", toolkit_->mesh(name_of(current), frames_of({&current})));
  } else {
    call.read("target", model);
  }
  const Request request = request_of(operation_of(kTransfer), rows);
  call.give("source", sequence_of(rows, "source", request.reading,
                                  visible_layers(document, to_layer ? &current : nullptr)));
  if (!rows.getBool("full")) call.want("regions-out");
  run(call, request);

  const Frames result = toolkit_->frames_of(call.output("out"));
  const Data regions = call.output("regions-out");
  const std::string name = to_layer ? name_of(current) : toolkit_->name_of(call.output("out"));
  MeshModel* base = to_layer ? &current : nullptr;
  for (std::int64_t i = 0; i < result.count; ++i) {
    base = &add_layer(document, numbered(name, i), result, i, base);
    if (regions) show_regions(*base, toolkit_->field(regions, "region"));
  }
  Log(GLLogStream::FILTER, std::to_string(result.count) + " frames are new, hidden layers");
  save_outputs(call, request);
}

Data FilterMimetra::sequence_of(const RichParameterList& rows, const char* input,
                                const std::vector<std::string>& reading,
                                const std::vector<MeshModel*>& layers) const {
  const std::string path = text_of(rows, input);
  if (!path.empty()) return toolkit_->load_sequence(path, reading);
  if (!reading.empty()) {
    throw Failure("further options: " + reading.front() + " speaks of files; name them as the " +
                  input);
  }
  if (layers.empty()) {
    throw Failure(std::string("there are no frames: show the layers that are the ") + input +
                  ", or name its files");
  }
  return toolkit_->sequence("layers", frames_of(layers));
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

const mimetra_operation& FilterMimetra::operation_of(FilterIDType filter) const {
  return toolkit_->operation(kFilters.at(filter).operation);
}

MESHLAB_PLUGIN_NAME_EXPORTER(FilterMimetra)
