#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "plugins/c/mimetra.h"

/// mimetra's C interface for C++: handles that free themselves, errors as exceptions.
namespace mimetra_meshlab {

/// What went wrong, in words for people.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The shortest text that is this number: 0.1 of a float, where a double of it would be
/// 0.100000001.
std::string shortest_text(float value);
std::string shortest_text(double value);

using Data = std::shared_ptr<const mimetra_data>;

/// Positions F x N x 3 and polygons: their sizes, and the vertices of one after the other.
struct Frames {
  std::vector<double> positions;
  std::vector<std::int32_t> face_sizes;
  std::vector<std::int32_t> corners;
  std::int64_t count = 0;
  std::int64_t vertices = 0;
};

/// The operations, and the values that they work on. Functions throw Failure.
class Toolkit {
 public:
  /// Messages while loading and running go to `log`.
  Toolkit(mimetra_log log, void* user);
  ~Toolkit();
  Toolkit(const Toolkit&) = delete;
  Toolkit& operator=(const Toolkit&) = delete;

  /// All of them, those of plugins too.
  std::vector<const mimetra_operation*> operations() const;

  Data sequence(const std::string& name, const Frames& frames) const;
  /// A model without expressions, of the first frame: what a transfer takes as a mesh.
  Data mesh(const std::string& name, const Frames& frames) const;
  /// A sequence of whatever the command reads as one; settings are "frames=0:100" and the like.
  Data load_sequence(const std::string& text, const std::vector<std::string>& settings) const;
  /// Writes a value as the command does.
  void save(const Data& data, const std::string& path) const;
  std::string name_of(const Data& data) const;
  /// A sequence's positions and faces.
  Frames frames_of(const Data& data) const;
  /// Names of the fields that have one number for each vertex.
  std::vector<std::string> vertex_fields(const Data& data) const;
  /// The numbers of a vertex field.
  std::vector<double> field(const Data& data, const char* name) const;
  /// A table as lines of CSV; an empty cell is empty.
  std::vector<std::string> lines_of(const Data& table) const;

 private:
  friend class Call;
  void check(mimetra_status status) const;
  std::vector<const mimetra_array*> arrays(const Data& data) const;
  const mimetra_array& array(const Data& data, const char* name) const;
  Data made_of(mimetra_kind kind, const std::string& name, const mimetra_array& positions,
               const Frames& faces) const;
  Data owned(mimetra_data* data) const;

  const mimetra_interface* functions_;
  mimetra_context* context_ = nullptr;
};

/// One operation with its inputs and parameters, to be run. Functions throw Failure.
class Call {
 public:
  Call(const Toolkit& toolkit, const char* operation);
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  void set(const char* parameter, const std::string& text);
  void give(const char* input, const Data& data);
  /// The value of an input from a file.
  void read(const char* input, const std::string& text);
  void want(const char* output);
  /// Asks for the manifest of the run, in a file that does not exist.
  void write_manifest(const std::string& path);
  /// `progress` gets the share of the work that is done; 0 as its answer cancels.
  void run(mimetra_progress progress, void* user);
  /// Null where the call has not made it.
  Data output(const char* name) const;
  /// The result for people, or for programs where it has no other.
  std::string summary() const;

 private:
  const Toolkit& toolkit_;
  mimetra_call* call_ = nullptr;
};

}  // namespace mimetra_meshlab
