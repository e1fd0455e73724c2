#pragma once

#include <functional>
#include <vector>

#include <vtkDataObject.h>
#include <vtkMultiProcessStream.h>
#include <vtkSmartPointer.h>

class vtkMultiProcessController;

void put_times(vtkMultiProcessStream& words, const std::vector<double>& times);
std::vector<double> taken_times(vtkMultiProcessStream& words);

/// The processes of a server. All processes must call a function marked as collective, or the
/// others wait forever.
class Processes {
 public:
  using Data = std::vector<vtkSmartPointer<vtkDataObject>>;

  explicit Processes(vtkMultiProcessController& controller) : controller_(&controller) {}

  bool is_first() const;
  /// Returns data for each process: null.
  Data nothing() const;
  /// Collective. Returns whether `mine` is true on all processes.
  bool all(bool mine);
  /// Collective. Throws std::bad_alloc on all processes if `work` throws it on one.
  void together(const std::function<void()>& work);
  /// Collective. Returns the words of the first process.
  vtkMultiProcessStream told(vtkMultiProcessStream words);
  /// Collective. Returns the words of all processes on the first one, and none on the others.
  std::vector<vtkMultiProcessStream> gathered(const vtkMultiProcessStream& words);
  /// Collective. Sends data to each process, and returns those from each; null for no data. Throws
  /// std::bad_alloc on all processes if one lacks memory. VTK's format cuts ids to 32 bits.
  Data exchanged(const Data& mine);

 private:
  vtkMultiProcessController* controller_;
};
