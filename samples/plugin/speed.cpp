// A plugin in C++. Its operation `speed` shows how fast each vertex moves, as fields on the mesh.
// Build it as a shared library in a folder of MIMETRA_PLUGIN_PATH, and run `mimetra speed take.npy
// -o speed.pvd`.

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <mimetra/plugins/c/mimetra.h>

namespace {

/// Throws unless the status is MIMETRA_OK. The host reports exceptions from run().
void check(mimetra_status status, const mimetra_interface* m, mimetra_context* context) {
  if (status != MIMETRA_OK) throw std::runtime_error(m->message(context));
}

mimetra_status run(const mimetra_interface* m, mimetra_job* job, void*) {
  mimetra_context* context = m->job_context(job);
  const mimetra_data* sequence = m->job_input(job, "sequence", 0);
  const auto array = [&](const char* name) {
    const mimetra_array* found = nullptr;
    check(m->data_array(context, sequence, name, &found), m, context);
    return found;
  };
  const auto* positions = array("positions");
  const auto* xyz = static_cast<const double*>(positions->values);
  const auto* times = static_cast<const double*>(array("times")->values);
  const auto frames = positions->shape[0], vertices = positions->shape[1];
  if (frames < 2) return m->job_fail(job, MIMETRA_MISMATCH, "one frame has no speed");

  std::vector<double> mean(vertices), most(vertices);
  for (std::int64_t f = 1; f < frames; ++f) {
    if (times[f] <= times[f - 1]) return m->job_fail(job, MIMETRA_BAD_INPUT, "times do not rise");
    for (std::int64_t v = 0; v < vertices; ++v) {
      const double* now = xyz + 3 * (f * vertices + v);
      const double* before = now - 3 * vertices;
      const double way = std::hypot(now[0] - before[0], now[1] - before[1], now[2] - before[2]);
      mean[v] += way / (times[frames - 1] - times[0]);
      most[v] = std::max(most[v], way / (times[f] - times[f - 1]));
    }
    if (m->job_progress(job, double(f) / double(frames)) != MIMETRA_OK) return MIMETRA_CANCELLED;
  }

  mimetra_array speed = {sizeof speed,        MIMETRA_F64, 1,          MIMETRA_ON_VERTICES,
                         {vertices, 0, 0, 0}, "speed",     mean.data()};
  mimetra_array top_speed = speed;
  top_speed.name = "top_speed";
  top_speed.values = most.data();
  const mimetra_array* list[] = {positions,        array("times"), array("face_sizes"),
                                 array("corners"), &speed,         &top_speed,
                                 nullptr};
  mimetra_data* made = nullptr;
  check(m->new_data(context, MIMETRA_SEQUENCE, m->data_name(sequence), list, &made), m, context);
  const std::unique_ptr<mimetra_data, void (*)(mimetra_data*)> owner(made, m->free_data);
  check(m->job_output(job, "out", made), m, context);
  const std::string top = std::to_string(*std::max_element(most.begin(), most.end()));
  return m->job_report(job, ("{\"top_speed\": " + top + "}").c_str(),
                       ("the fastest vertex moves by " + top + " in a second").c_str());
}

const mimetra_port kInput = {sizeof kInput, MIMETRA_SEQUENCE, "sequence", "what moves", 0, 0};
const mimetra_port kOutput = {
    sizeof kOutput, MIMETRA_SEQUENCE, "out", "the mesh with its speeds", MIMETRA_WITH_FIELDS, 0};
const mimetra_port* const kInputs[] = {&kInput, nullptr};
const mimetra_port* const kOutputs[] = {&kOutput, nullptr};
const mimetra_operation kOperation = {
    sizeof kOperation, 0,   "speed", "Show how fast each vertex moves", kInputs, kOutputs, nullptr,
    nullptr,           run, nullptr};
const mimetra_operation* const kOperations[] = {&kOperation, nullptr};
const mimetra_plugin kPlugin = {sizeof kPlugin, MIMETRA_INTERFACE_VERSION, "speed sample",
                                kOperations, nullptr};

}  // namespace

const mimetra_plugin* mimetra_get_plugin() {
  return &kPlugin;
}
