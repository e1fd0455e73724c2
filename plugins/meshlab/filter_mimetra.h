#pragma once

#include <memory>

#include <common/interfaces.h>

#include "plugins/meshlab/dialog.h"
#include "plugins/meshlab/toolkit.h"

/// The operations of the table that begin with a mesh, as filters of MeshLab. A sequence is the
/// visible layers in their order, or what a path names.
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
  /// What MeshLab knows of a filter.
  struct Filter {
    QString name;
    const mimetra_operation* operation;
    QString info;
    int filter_class;
    int changes;  ///< what of layers, in MeshModel's bits
    FILTER_ARITY arity;
    void (*add_rows)(const mimetra_operation& operation, RichParameterList& rows);
    void (FilterMimetra::*run)(const mimetra_operation& operation, MeshDocument& document,
                               const RichParameterList& rows);
  };

  /// Has one of its own where MeshLab needs more than a call: vertices that are selected, regions
  /// that become a selection, or the regions of a result on its layers.
  static Filter filter_of(const mimetra_operation& operation);
  static Filter filter_of_layers(const mimetra_operation& operation);

  void run_geodesic(const mimetra_operation& operation, MeshDocument& document,
                    const RichParameterList& rows);
  void run_regions(const mimetra_operation& operation, MeshDocument& document,
                   const RichParameterList& rows);
  void run_transfer(const mimetra_operation& operation, MeshDocument& document,
                    const RichParameterList& rows);
  /// Any other operation, by the kinds of what it takes and makes.
  void run_on_layers(const mimetra_operation& operation, MeshDocument& document,
                     const RichParameterList& rows);

  /// Gives a call what it needs: the visible layers as a sequence, the current one as a mesh, or
  /// what the paths in their rows name. The layers that were taken as frames, or as the mesh where
  /// there are no frames.
  std::vector<MeshModel*> give_inputs(mimetra_meshlab::Call& call,
                                      const mimetra_operation& operation, MeshDocument& document,
                                      const RichParameterList& rows,
                                      const std::vector<std::string>& reading) const;
  /// The frames of `layers`, or those of a path that stands in the row of `input`.
  mimetra_meshlab::Data sequence_of(const RichParameterList& rows, const char* input,
                                    const std::vector<std::string>& reading,
                                    const std::vector<MeshModel*>& layers) const;
  /// Frames as new, hidden layers that look like `base`, which may be null, or the new ones before.
  std::vector<MeshModel*> add_layers(MeshDocument& document, const std::string& name,
                                     const mimetra_meshlab::Frames& frames, MeshModel* base);
  /// Fields as the quality of the layers `given`, or of new ones where they are on another shape.
  void show_fields(MeshDocument& document, const std::string& name,
                   const mimetra_meshlab::Data& fields, const std::vector<MeshModel*>& given,
                   const std::string& field);
  void run(mimetra_meshlab::Call& call, const mimetra_meshlab::Request& request);
  /// Writes further outputs; last, so that a file that cannot be written costs no result.
  void save_outputs(const mimetra_meshlab::Call& call,
                    const mimetra_meshlab::Request& request) const;

  const Filter& filter(QAction* action) const { return filters_[ID(action)]; }

  std::unique_ptr<mimetra_meshlab::Toolkit> toolkit_;
  std::vector<Filter> filters_;
  vcg::CallBackPos* progress_ = nullptr;
};
