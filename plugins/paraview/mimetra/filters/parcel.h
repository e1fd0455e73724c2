#pragma once

#include <optional>
#include <vector>

#include <vtkDataArray.h>
#include <vtkMultiProcessStream.h>
#include <vtkSmartPointer.h>

class vtkMultiProcessController;
class vtkPolyData;

/// Words and arrays of numbers that go from one process to another, and are taken out in the order
/// in which they were put in.
class Parcel {
 public:
  vtkMultiProcessStream words;

  /// The array is shared, or copied where its memory is not one block.
  void put(vtkDataArray* array);
  vtkSmartPointer<vtkDataArray> take();

 private:
  friend class Processes;

  /// Names, types and sizes of the arrays, and the words.
  vtkMultiProcessStream header() const;
  /// Arrays that are as a header says, without their numbers. Throws std::bad_alloc.
  static Parcel laid_out(vtkMultiProcessStream& header);

  std::vector<vtkSmartPointer<vtkDataArray>> arrays_;
  std::size_t next_ = 0;
};

/// Words in words. VTK's own operator writes beyond its memory where there are more than 512 bytes.
void put_words(vtkMultiProcessStream& words, const vtkMultiProcessStream& inner);
vtkMultiProcessStream taken_words(vtkMultiProcessStream& words);

void put_times(vtkMultiProcessStream& words, const std::vector<double>& times);
std::vector<double> taken_times(vtkMultiProcessStream& words);

/// A piece of a mesh with its point, cell and field data that are numbers.
Parcel packed(vtkPolyData& piece);
vtkSmartPointer<vtkPolyData> unpacked(Parcel& parcel);

/// The processes of a server. What is said to be done by all, each must call, or the others wait
/// for ever.
class Processes {
 public:
  explicit Processes(vtkMultiProcessController& controller) : controller_(&controller) {}

  int count() const;
  bool is_first() const;
  /// By all: true where it is true on all.
  bool all(bool mine);
  /// By all: what the first one says.
  vtkMultiProcessStream told(vtkMultiProcessStream words);
  /// By all: the parcels of all on the first one, none on the others. No value on all where some
  /// process has no memory for them, as one without its own.
  std::optional<std::vector<Parcel>> gather(std::optional<Parcel> mine);
  /// By all: a parcel of the first for each. No value on all where some process has no memory.
  std::optional<Parcel> scatter(std::vector<Parcel> parcels);

 private:
  /// What makes room for a parcel goes ahead of it. False where there is none, or no memory, which
  /// the other process then learns.
  bool announce(const Parcel* parcel, int to);
  /// No value where none was announced, or there is no memory for it.
  std::optional<Parcel> announced(int from);
  void send(const Parcel& parcel, int to);
  void receive(Parcel& parcel, int from);

  vtkMultiProcessController* controller_;
};
