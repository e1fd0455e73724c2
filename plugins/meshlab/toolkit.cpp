#include "plugins/meshlab/toolkit.h"

#include <array>
#include <charconv>
#include <cmath>

namespace mimetra_meshlab {

namespace {

mimetra_array array_of(const char* name, std::int32_t type, std::vector<std::int64_t> shape,
                       const void* values) {
  mimetra_array array = {};
  array.struct_size = sizeof array;
  array.type = type;
  array.rank = static_cast<std::int32_t>(shape.size());
  for (std::size_t i = 0; i < shape.size(); ++i) array.shape[i] = shape[i];
  array.name = name;
  array.values = values;
  return array;
}

std::int64_t size_of(const mimetra_array& array) {
  std::int64_t size = 1;
  for (int i = 0; i < array.rank; ++i) size *= array.shape[i];
  return size;
}

template <typename T>
std::vector<T> values_of(const mimetra_array& array) {
  const T* values = static_cast<const T*>(array.values);
  return {values, values + size_of(array)};
}

template <typename Number>
std::string shortest(Number value) {
  std::array<char, 32> text = {};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace

std::string shortest_text(float value) {
  return shortest(value);
}

std::string shortest_text(double value) {
  return shortest(value);
}

Toolkit::Toolkit(mimetra_log log, void* user)
    : functions_(mimetra_get_interface(MIMETRA_INTERFACE_VERSION)) {
  if (!functions_) throw Failure("the installed mimetra is another version than this plugin's");
  if (functions_->new_context(log, user, &context_) != MIMETRA_OK) {
    throw Failure("mimetra's operations cannot be set up");
  }
}

Toolkit::~Toolkit() {
  functions_->free_context(context_);
}

std::vector<const mimetra_operation*> Toolkit::operations() const {
  std::vector<const mimetra_operation*> all;
  for (auto each = functions_->operations(context_); *each; ++each) all.push_back(*each);
  return all;
}

Data Toolkit::sequence(const std::string& name, const Frames& frames) const {
  return made_of(MIMETRA_SEQUENCE, name,
                 array_of("positions", MIMETRA_F64, {frames.count, frames.vertices, 3},
                          frames.positions.data()),
                 frames);
}

Data Toolkit::mesh(const std::string& name, const Frames& frames) const {
  return made_of(MIMETRA_MODEL, name,
                 array_of("neutral", MIMETRA_F64, {frames.vertices, 3}, frames.positions.data()),
                 frames);
}

Data Toolkit::load_sequence(const std::string& text,
                            const std::vector<std::string>& settings) const {
  std::vector<const char*> pairs;
  for (const std::string& setting : settings) pairs.push_back(setting.c_str());
  pairs.push_back(nullptr);
  mimetra_data* data = nullptr;
  check(functions_->load_data(context_, MIMETRA_SEQUENCE, text.c_str(), pairs.data(), &data));
  return owned(data);
}

void Toolkit::save(const Data& data, const std::string& path) const {
  check(functions_->save_data(context_, data.get(), path.c_str(), nullptr));
}

std::string Toolkit::name_of(const Data& data) const {
  return functions_->data_name(data.get());
}

Frames Toolkit::frames_of(const Data& data) const {
  const mimetra_array& positions = array(data, "positions");
  return {values_of<double>(positions), values_of<std::int32_t>(array(data, "face_sizes")),
          values_of<std::int32_t>(array(data, "corners")), positions.shape[0], positions.shape[1]};
}

std::vector<std::string> Toolkit::vertex_fields(const Data& data) const {
  std::vector<std::string> names;
  for (const mimetra_array* each : arrays(data)) {
    if (each->location == MIMETRA_ON_VERTICES && each->rank == 1) names.emplace_back(each->name);
  }
  return names;
}

std::vector<double> Toolkit::field(const Data& data, const char* name) const {
  const mimetra_array& found = array(data, name);
  if (found.type == MIMETRA_F64) return values_of<double>(found);
  if (found.type != MIMETRA_I32) throw Failure(std::string(name) + " is no field of numbers");
  const std::vector<std::int32_t> values = values_of<std::int32_t>(found);
  return {values.begin(), values.end()};
}

std::vector<std::string> Toolkit::lines_of(const Data& table) const {
  std::vector<std::string> lines(1);
  const std::vector<const mimetra_array*> columns = arrays(table);
  for (const mimetra_array* column : columns) {
    const char* comma = column == columns.front() ? "" : ",";
    lines.front() += std::string(comma) + column->name;
    const std::vector<double> values = values_of<double>(*column);
    lines.resize(values.size() + 1);
    for (std::size_t row = 0; row < values.size(); ++row) {
      lines[row + 1] += comma + (std::isnan(values[row]) ? "" : shortest_text(values[row]));
    }
  }
  return lines;
}

void Toolkit::check(mimetra_status status) const {
  if (status != MIMETRA_OK) throw Failure(functions_->message(context_));
}

std::vector<const mimetra_array*> Toolkit::arrays(const Data& data) const {
  const mimetra_array* const* list = nullptr;
  check(functions_->data_arrays(context_, data.get(), &list));
  std::vector<const mimetra_array*> all;
  for (; *list; ++list) all.push_back(*list);
  return all;
}

const mimetra_array& Toolkit::array(const Data& data, const char* name) const {
  const mimetra_array* found = nullptr;
  check(functions_->data_array(context_, data.get(), name, &found));
  return *found;
}

Data Toolkit::made_of(mimetra_kind kind, const std::string& name, const mimetra_array& positions,
                      const Frames& faces) const {
  const auto list = [](const char* array_name, const std::vector<std::int32_t>& values) {
    return array_of(array_name, MIMETRA_I32, {static_cast<std::int64_t>(values.size())},
                    values.data());
  };
  const mimetra_array sizes = list("face_sizes", faces.face_sizes);
  const mimetra_array corners = list("corners", faces.corners);
  const mimetra_array* arrays[] = {&positions, &sizes, &corners, nullptr};
  mimetra_data* data = nullptr;
  check(functions_->new_data(context_, kind, name.c_str(), arrays, &data));
  return owned(data);
}

Data Toolkit::owned(mimetra_data* data) const {
  const auto free_data = functions_->free_data;
  return {data, [free_data](mimetra_data* held) { free_data(held); }};
}

Call::Call(const Toolkit& toolkit, const char* operation) : toolkit_(toolkit) {
  toolkit_.check(toolkit_.functions_->new_call(toolkit_.context_, operation, &call_));
}

Call::~Call() {
  toolkit_.functions_->free_call(call_);
}

void Call::set(const char* parameter, const std::string& text) {
  toolkit_.check(toolkit_.functions_->call_set(call_, parameter, text.c_str()));
}

void Call::give(const char* input, const Data& data) {
  toolkit_.check(toolkit_.functions_->call_give(call_, input, data.get()));
}

void Call::read(const char* input, const std::string& text) {
  toolkit_.check(toolkit_.functions_->call_read(call_, input, text.c_str()));
}

void Call::want(const char* output) {
  toolkit_.check(toolkit_.functions_->call_want(call_, output));
}

void Call::write_manifest(const std::string& path) {
  const std::int32_t replace = 0;
  toolkit_.check(toolkit_.functions_->call_write(call_, nullptr, path.c_str(), replace));
}

void Call::run(mimetra_progress progress, void* user) {
  const mimetra_interface& functions = *toolkit_.functions_;
  toolkit_.check(functions.set_progress(toolkit_.context_, progress, user));
  const mimetra_status status = functions.call_run(call_);
  const std::string message = status == MIMETRA_OK ? "" : functions.message(toolkit_.context_);
  functions.set_progress(toolkit_.context_, nullptr, nullptr);
  if (status != MIMETRA_OK) throw Failure(message);
}

Data Call::output(const char* name) const {
  if (toolkit_.functions_->call_output_count(call_, name) == 0) return nullptr;
  mimetra_data* data = nullptr;
  toolkit_.check(toolkit_.functions_->call_output(call_, name, 0, &data));
  return toolkit_.owned(data);
}

std::string Call::summary() const {
  const std::string text = toolkit_.functions_->call_summary(call_);
  return text.empty() ? toolkit_.functions_->call_report(call_) : text;
}

}  // namespace mimetra_meshlab
