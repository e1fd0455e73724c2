#pragma once

#include <optional>
#include <vector>

#include <vtkDataArray.h>
#include <vtkMultiProcessStream.h>
#include <vtkSmartPointer.h>

class vtkMultiProcessController;
class vtkPolyData;

/// Words and arrays of numbers that one process sends to another. They are taken out in the order
/// in which they were put in.
class Parcel {
 public:
  vtkMultiProcessStream words;

  /// Shares the array, or copies it if its memory is not one block.
  void put(vtkDataArray* array);
  vtkSmartPointer<vtkDataArray> take();

 private:
  friend class Processes;

  /// Names, types and sizes of the arrays, and the words.
  vtkMultiProcessStream header() const;
  /// Allocates the arrays that a header describes, without their numbers. Throws std::bad_alloc.
  static Parcel laid_out(vtkMultiProcessStream& header);

  std::vector<vtkSmartPointer<vtkDataArray>> arrays_;
  std::size_t next_ = 0;
};

/// Nests words in words. VTK's own operator writes beyond its memory for more than 512 bytes.
void put_words(vtkMultiProcessStream& words, const vtkMultiProcessStream& inner);
vtkMultiProcessStream taken_words(vtkMultiProcessStream& words);

void put_times(vtkMultiProcessStream& words, const std::vector<double>& times);
std::vector<double> taken_times(vtkMultiProcessStream& words);

/// Packs a piece of a mesh with its named numeric point, cell and field data.
Parcel packed(vtkPolyData& piece);
vtkSmartPointer<vtkPolyData> unpacked(Parcel& parcel);

/// The processes of a server. All processes must call a function marked as collective, or the
/// others wait forever.
class Processes {
 public:
  explicit Processes(vtkMultiProcessController& controller) : controller_(&controller) {}

  int count() const;
  bool is_first() const;
  /// Collective. Returns whether `mine` is true on all processes.
  bool all(bool mine);
  /// Collective. Returns the words of the first process.
  vtkMultiProcessStream told(vtkMultiProcessStream words);
  /// Collective. Returns the parcels of all processes on the first one, and none on the others.
  /// Returns no value on all processes if one passes no parcel or lacks memory.
  std::optional<std::vector<Parcel>> gather(std::optional<Parcel> mine);
  /// Collective. Gives each process its parcel from the first one. Returns no value on all
  /// processes if one lacks memory.
  std::optional<Parcel> scatter(std::vector<Parcel> parcels);

 private:
  /// Sends the header of a parcel, so that the other process can allocate it. Returns false and
  /// sends an empty header if there is no parcel or no memory.
  bool announce(const Parcel* parcel, int to);
  /// Receives a header and allocates its parcel. Returns no value if the header is empty or memory
  /// is short.
  std::optional<Parcel> announced(int from);
  void send(const Parcel& parcel, int to);
  void receive(Parcel& parcel, int from);

  vtkMultiProcessController* controller_;
};
