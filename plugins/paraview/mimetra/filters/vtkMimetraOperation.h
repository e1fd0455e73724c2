#pragma once

#include <string>

#include <vtkNew.h>
#include <vtkPolyData.h>

#include "plugins/paraview/mimetra/filters/vtkMimetraFilter.h"

/// Any operation that begins with a mesh over time and needs only a call from ParaView. A sequence
/// or fields on the input's own faces are shown with the input's data; on other faces, as a
/// separate mesh. Tables, or else the report, are shown as tables.
class MIMETRAFILTERS_EXPORT vtkMimetraOperation : public vtkMimetraFilter {
 public:
  vtkTypeMacro(vtkMimetraOperation, vtkMimetraFilter);
  static vtkMimetraOperation* New();

  /// Sets the operation; call this before anything else.
  void SetOperation(const char* name);

 protected:
  vtkMimetraOperation();
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  bool moves(int port) const override;
  std::vector<std::string> wanted_outputs(const mimetra::Invocation& invocation) override;
  void prepare(const mimetra::Outcome& outcome, vtkPolyData& input) override;
  void show(const mimetra::Outcome& outcome, vtkPolyData& input, double time,
            vtkInformationVector* outputs) override;

 private:
  enum class Shown { on_the_input, in_another_shape, as_a_mesh_of_its_own };

  void prepare_mesh(const mimetra::Outcome& outcome, vtkPolyData& input);
  void show_made(const mimetra::Outcome& outcome, vtkPolyData& input, double time,
                 vtkPolyData& output);

  Shown shown_ = Shown::on_the_input;
  vtkNew<vtkPolyData> shared_;  ///< fields, and faces unless the input's, of all time steps
};
