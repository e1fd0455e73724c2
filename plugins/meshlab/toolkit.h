#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "plugins/c/mimetra.h"

/// C++ wrapper of mimetra's C interface. Handles free themselves, and errors are exceptions.
namespace mimetra_meshlab {

/// Error with a message for users.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Shortest text that reads back as this number, as "0.1" for a float that is 0.100000001 as a
/// double.
std::string shortest_text(float value);
std::string shortest_text(double value);

using Data = std::shared_ptr<const mimetra_data>;

/// Positions (F x N x 3) and polygons: their sizes, then the vertices of all polygons.
struct Frames {
  std::vector<double> positions;
  std::vector<std::int32_t> face_sizes;
  std::vector<std::int32_t> corners;
  std::int64_t count = 0;
  std::int64_t vertices = 0;
};

/// Operations, and functions for the values that they work on. Functions throw Failure.
class Toolkit {
 public:
  /// Messages while loading and running go to `log`.
  Toolkit(mimetra_log log, void* user);
  ~Toolkit();
  Toolkit(const Toolkit&) = delete;
  Toolkit& operator=(const Toolkit&) = delete;

  /// All operations, including plugins.
  std::vector<const mimetra_operation*> operations() const;

  Data sequence(const std::string& name, const Frames& frames) const;
  /// A model without expressions, from the first frame. A transfer accepts it as a mesh.
  Data mesh(const std::string& name, const Frames& frames) const;
  /// Reads a sequence as the command does. Settings are "frames=0:100" and the like.
  Data load_sequence(const std::string& text, const std::vector<std::string>& settings) const;
  /// Writes a value as the command does.
  void save(const Data& data, const std::string& path) const;
  std::string name_of(const Data& data) const;
  /// Positions and faces of a sequence.
  Frames frames_of(const Data& data) const;
  /// Names of the fields with one number for each vertex.
  std::vector<std::string> vertex_fields(const Data& data) const;
  /// Numbers of a vertex field.
  std::vector<double> field(const Data& data, const char* name) const;
  /// Lines of a table as CSV. NaN becomes an empty cell.
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

/// One operation with its inputs and parameters. Functions throw Failure.
class Call {
 public:
  Call(const Toolkit& toolkit, const char* operation);
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  void set(const char* parameter, const std::string& text);
  void give(const char* input, const Data& data);
  /// Reads the value of an input from a file.
  void read(const char* input, const std::string& text);
  void want(const char* output);
  /// Asks for the manifest of the run, in a file that does not exist yet.
  void write_manifest(const std::string& path);
  /// `progress` gets the share of the work done and returns 0 to cancel.
  void run(mimetra_progress progress, void* user);
  /// Null if the run did not make the output.
  Data output(const char* name) const;
  /// Summary for users, or the JSON report if there is no summary.
  std::string summary() const;

 private:
  const Toolkit& toolkit_;
  mimetra_call* call_ = nullptr;
};

}  // namespace mimetra_meshlab
