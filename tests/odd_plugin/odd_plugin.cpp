// Operations with names and values that are unusual but allowed: every host must take them.

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "plugins/c/mimetra.h"

namespace {

// What a host may call something of its own.
constexpr const char* kWords[] = {"name",       "operation", "frames", "execute",
                                  "properties", "layout",    "cancel", "class"};

mimetra_array array_of(const char* name, int32_t type, std::initializer_list<int64_t> shape,
                       const void* values, int32_t location = MIMETRA_NOWHERE) {
  mimetra_array array{sizeof array, type,  static_cast<int32_t>(shape.size()), location, {},
                      name,         values};
  int64_t* size = array.shape;
  for (const int64_t each : shape) *size++ = each;
  return array;
}

mimetra_status make(const mimetra_interface* m, mimetra_job* job, const char* output,
                    mimetra_kind kind, const std::vector<mimetra_array>& arrays) {
  std::vector<const mimetra_array*> list;
  for (const mimetra_array& array : arrays) list.push_back(&array);
  list.push_back(nullptr);
  mimetra_data* made = nullptr;
  mimetra_status status = m->new_data(m->job_context(job), kind, output, list.data(), &made);
  if (!status) status = m->job_output(job, output, made);
  m->free_data(made);
  return status;
}

mimetra_status one_row(const mimetra_interface* m, mimetra_job* job, void*) {
  const double value = 1;
  return make(m, job, "out", MIMETRA_TABLE, {array_of("value", MIMETRA_F64, {1}, &value)});
}

/// Tells what the parameters were.
mimetra_status echo(const mimetra_interface* m, mimetra_job* job, void*) {
  std::string json;
  for (const char* word : kWords) {
    const char* text = m->job_text(job, word);
    if (!text) continue;
    json += (json.empty() ? "{\"" : ", \"") + std::string(word) + "\": \"" + text + '"';
  }
  const double value = 1;
  const mimetra_array column = array_of("one, \"two\"", MIMETRA_F64, {1}, &value);
  mimetra_status status = make(m, job, "report", MIMETRA_TABLE, {column});
  if (!status && m->job_wants(job, "summary")) {
    status = make(m, job, "summary", MIMETRA_TABLE, {column});
  }
  json = json.empty() ? "{}" : json + '}';
  return status ? status : m->job_report(job, json.c_str(), json.c_str());
}

/// Numbers of vertices, the last one far away.
mimetra_status labels(const mimetra_interface* m, mimetra_job* job, void*) {
  mimetra_context* context = m->job_context(job);
  const mimetra_data* sequence = m->job_input(job, "sequence", 0);
  const mimetra_array *positions = nullptr, *sizes = nullptr, *corners = nullptr;
  mimetra_status status = m->data_array(context, sequence, "positions", &positions);
  if (!status) status = m->data_array(context, sequence, "face_sizes", &sizes);
  if (!status) status = m->data_array(context, sequence, "corners", &corners);
  if (status) return status;
  std::vector<int32_t> values(static_cast<std::size_t>(positions->shape[1]), 3);
  values.front() = -1;
  values.back() = 2000000000;
  return make(
      m, job, "out", MIMETRA_SEQUENCE,
      {*positions, *sizes, *corners,
       array_of("label", MIMETRA_I32, {positions->shape[1]}, values.data(), MIMETRA_ON_VERTICES)});
}

/// A field on the triangles that polygons are made of, as faces of their own.
mimetra_status other_faces(const mimetra_interface* m, mimetra_job* job, void*) {
  mimetra_context* context = m->job_context(job);
  const mimetra_data* sequence = m->job_input(job, "sequence", 0);
  const mimetra_array *positions = nullptr, *triangles = nullptr;
  mimetra_status status = m->data_array(context, sequence, "positions", &positions);
  if (!status) status = m->data_array(context, sequence, "triangles", &triangles);
  if (status) return status;
  const std::vector<double> values(static_cast<std::size_t>(triangles->shape[0]), 1);
  return make(
      m, job, "out", MIMETRA_SEQUENCE,
      {*positions, *triangles,
       array_of("area", MIMETRA_F64, {triangles->shape[0]}, values.data(), MIMETRA_ON_TRIANGLES)});
}

/// A field of another mesh: one triangle.
mimetra_status other_vertices(const mimetra_interface* m, mimetra_job* job, void*) {
  const double corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const int32_t triangle[] = {0, 1, 2};
  const double values[] = {1, 2, 3};
  return make(m, job, "out", MIMETRA_SEQUENCE,
              {array_of("positions", MIMETRA_F64, {3, 3}, corners),
               array_of("triangles", MIMETRA_I32, {1, 3}, triangle),
               array_of("height", MIMETRA_F64, {3}, values, MIMETRA_ON_VERTICES)});
}

/// A set of all vertices but the first, without a mesh.
mimetra_status most(const mimetra_interface* m, mimetra_job* job, void*) {
  mimetra_context* context = m->job_context(job);
  const mimetra_data* sequence = m->job_input(job, "sequence", 0);
  const mimetra_array *positions = nullptr, *triangles = nullptr;
  mimetra_status status = m->data_array(context, sequence, "positions", &positions);
  if (!status) status = m->data_array(context, sequence, "triangles", &triangles);
  if (status) return status;
  const int64_t vertices = positions->shape[1];
  std::vector<uint8_t> mask(static_cast<std::size_t>(vertices), 1);
  mask.front() = 0;
  return make(m, job, "out", MIMETRA_REGIONS,
              {array_of("masks", MIMETRA_U8, {1, vertices}, mask.data()), *triangles});
}

mimetra_status landmarks(const mimetra_interface* m, mimetra_job* job, void*) {
  return m->job_fail(job, MIMETRA_FAILED, "ran although it makes nothing");
}

mimetra_port port(mimetra_kind kind, const char* name, uint32_t flags = 0) {
  return {sizeof(mimetra_port), kind, name, "something", flags, 0};
}

/// What describes an operation, as long as the process lives.
struct Described {
  Described(const char* name, mimetra_run run, std::vector<mimetra_port> inputs,
            std::vector<mimetra_port> outputs, std::vector<mimetra_parameter> parameters = {})
      : inputs_(std::move(inputs)),
        outputs_(std::move(outputs)),
        parameters_(std::move(parameters)) {
    for (const auto& each : inputs_) input_list_.push_back(&each);
    for (const auto& each : outputs_) output_list_.push_back(&each);
    for (const auto& each : parameters_) parameter_list_.push_back(&each);
    input_list_.push_back(nullptr);
    output_list_.push_back(nullptr);
    parameter_list_.push_back(nullptr);
    operation = {sizeof operation,
                 0,
                 name,
                 "An odd operation",
                 input_list_.data(),
                 output_list_.data(),
                 parameter_list_.data(),
                 nullptr,
                 run,
                 nullptr};
  }
  Described(const Described&) = delete;

  mimetra_operation operation;

 private:
  std::vector<mimetra_port> inputs_, outputs_;
  std::vector<mimetra_parameter> parameters_;
  std::vector<const mimetra_port*> input_list_, output_list_;
  std::vector<const mimetra_parameter*> parameter_list_;
};

std::vector<mimetra_parameter> words() {
  std::vector<mimetra_parameter> parameters;
  for (const char* word : kWords) {
    mimetra_parameter parameter{};
    parameter.struct_size = sizeof parameter;
    parameter.kind = MIMETRA_TEXT;
    parameter.name = word;
    parameter.help = "any text";
    parameters.push_back(parameter);
  }
  return parameters;
}

}  // namespace

const mimetra_plugin* mimetra_get_plugin() {
  static const std::vector<mimetra_port> sequence = {port(MIMETRA_SEQUENCE, "sequence")};
  static const std::vector<mimetra_port> fields = {
      port(MIMETRA_SEQUENCE, "out", MIMETRA_WITH_FIELDS)};
  static const std::vector<mimetra_port> table = {port(MIMETRA_TABLE, "out")};
  static const Described all[] = {
      {"echo",
       echo,
       {port(MIMETRA_DOCUMENT, "script", MIMETRA_OPTIONAL)},
       {port(MIMETRA_TABLE, "report"), port(MIMETRA_TABLE, "summary", MIMETRA_OPTIONAL),
        port(MIMETRA_DOCUMENT, "page", MIMETRA_OPTIONAL)},
       words()},
      {"labels", labels, sequence, fields},
      {"other-faces", other_faces, sequence, fields},
      {"other-vertices", other_vertices, sequence, fields},
      {"most", most, sequence, {port(MIMETRA_REGIONS, "out")}},
      {"landmarks", landmarks, {}, {port(MIMETRA_LANDMARKS, "out")}},
      {"a-name-that-is-longer-than-those-of-blenders-classes-may-be", one_row, {}, table}};
  static const std::vector<const mimetra_operation*> list = [] {
    std::vector<const mimetra_operation*> operations;
    for (const Described& each : all) operations.push_back(&each.operation);
    operations.push_back(nullptr);
    return operations;
  }();
  static const mimetra_plugin plugin = {sizeof plugin, MIMETRA_INTERFACE_VERSION, "odd",
                                        list.data(), nullptr};
  return &plugin;
}
