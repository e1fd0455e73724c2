#pragma once

#include <memory>

#include <common/interfaces.h>

#include "plugins/meshlab/dialog.h"
#include "plugins/meshlab/toolkit.h"

/// Filters of MeshLab for the operations that begin with a mesh. A sequence consists of the visible
/// layers in order, or comes from a path.
class FilterMimetra : public QObject, public MeshFilterInterface {
  Q_OBJECT
  MESHLAB_PLUGIN_IID_EXPORTER(MESH_FILTER_INTERFACE_IID)
  Q_INTERFACES(MeshFilterInterface)

 public:
  FilterMimetra();

  QString pluginName() const override;
  QString filterName(FilterIDType filter) const override;
  QString filterInfo(FilterIDType filter) const override;
  FilterClass getClass(QAction* action) override;
  int getPreConditions(QAction* action) const override;
  int postCondition(QAction* action) const override;
  FILTER_ARITY filterArity(QAction* action) const override;
  void initParameterSet(QAction* action, MeshDocument& document, RichParameterList& rows) override;
  bool applyFilter(QAction* action, MeshDocument& document, const RichParameterList& rows,
                   vcg::CallBackPos* progress) override;

 private:
  /// Properties of a filter in MeshLab.
  struct Filter {
    QString name;
    const mimetra_operation* operation;
    QString info;
    int filter_class;
    int changes;  ///< changed data of layers, as MeshModel's bits
    FILTER_ARITY arity;
    void (*add_rows)(const mimetra_operation& operation, RichParameterList& rows);
    void (FilterMimetra::*run)(const mimetra_operation& operation, MeshDocument& document,
                               const RichParameterList& rows);
  };

  /// Filter for an operation. Some operations have their own filter, because they need selected
  /// vertices, select regions, or show regions of a result on its layers.
  static Filter filter_of(const mimetra_operation& operation);
  static Filter filter_of_layers(const mimetra_operation& operation);

  void run_geodesic(const mimetra_operation& operation, MeshDocument& document,
                    const RichParameterList& rows);
  void run_regions(const mimetra_operation& operation, MeshDocument& document,
                   const RichParameterList& rows);
  void run_transfer(const mimetra_operation& operation, MeshDocument& document,
                    const RichParameterList& rows);
  /// Runs any other operation, according to the kinds of its inputs and outputs.
  void run_on_layers(const mimetra_operation& operation, MeshDocument& document,
                     const RichParameterList& rows);

  /// Gives a call its required inputs: the visible layers as a sequence, the current layer as a
  /// mesh, or the paths in their rows. Returns the layers that are frames, or the mesh's layer if
  /// the operation takes no frames.
  std::vector<MeshModel*> give_inputs(mimetra_meshlab::Call& call,
                                      const mimetra_operation& operation, MeshDocument& document,
                                      const RichParameterList& rows,
                                      const std::vector<std::string>& reading) const;
  /// Sequence of `layers`, or of the path in the row of `input` if that is not empty.
  mimetra_meshlab::Data sequence_of(const RichParameterList& rows, const char* input,
                                    const std::vector<std::string>& reading,
                                    const std::vector<MeshModel*>& layers) const;
  /// Adds frames as hidden layers that look like `base`, or like the first new layer if it is null.
  std::vector<MeshModel*> add_layers(MeshDocument& document, const std::string& name,
                                     const mimetra_meshlab::Frames& frames, MeshModel* base);
  /// Shows a field as the quality of the layers `given`, or of new layers if the shape differs.
  void show_fields(MeshDocument& document, const std::string& name,
                   const mimetra_meshlab::Data& fields, const std::vector<MeshModel*>& given,
                   const std::string& field);
  void run(mimetra_meshlab::Call& call, const mimetra_meshlab::Request& request);
  /// Writes the files last, so that a file that cannot be written does not lose a result.
  void save_outputs(const mimetra_meshlab::Call& call,
                    const mimetra_meshlab::Request& request) const;

  const Filter& filter(QAction* action) const { return filters_[ID(action)]; }

  std::unique_ptr<mimetra_meshlab::Toolkit> toolkit_;
  std::vector<Filter> filters_;
  vcg::CallBackPos* progress_ = nullptr;
};
