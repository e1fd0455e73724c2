#pragma once

#include <memory>

#include <common/interfaces.h>

#include "plugins/meshlab/dialog.h"
#include "plugins/meshlab/toolkit.h"

/// mimetra's operations as filters of MeshLab. A sequence is the visible layers in their order, or
/// what a path names.
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
  enum { kGeodesic, kRegions, kTransfer };

  void run_geodesic(MeshDocument& document, const RichParameterList& rows);
  void run_regions(MeshDocument& document, const RichParameterList& rows);
  void run_transfer(MeshDocument& document, const RichParameterList& rows);

  /// The frames of `layers`, or those of a path that stands in the row of `input`.
  mimetra_meshlab::Data sequence_of(const RichParameterList& rows, const char* input,
                                    const std::vector<std::string>& reading,
                                    const std::vector<MeshModel*>& layers) const;
  void run(mimetra_meshlab::Call& call, const mimetra_meshlab::Request& request);
  /// Writes further outputs; last, so that a file that cannot be written costs no result.
  void save_outputs(const mimetra_meshlab::Call& call,
                    const mimetra_meshlab::Request& request) const;
  const mimetra_operation& operation_of(FilterIDType filter) const;

  std::unique_ptr<mimetra_meshlab::Toolkit> toolkit_;
  vcg::CallBackPos* progress_ = nullptr;
};
