// An operation that can be used, and whose run does something wrong, which its parameter chooses.

#include <cmath>
#include <new>
#include <stdexcept>
#include <string_view>

#include "plugins/c/mimetra.h"

namespace {

mimetra_status make(const mimetra_interface* m, mimetra_job* job, double z, const char* name) {
  const double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, z};
  const std::int32_t corners[] = {0, 1, 2};
  const mimetra_array arrays[] = {
      {sizeof(mimetra_array), MIMETRA_F64, 2, 0, {3, 3, 0, 0}, name, positions},
      {sizeof(mimetra_array), MIMETRA_I32, 2, 0, {1, 3, 0, 0}, "triangles", corners}};
  const mimetra_array* const list[] = {&arrays[0], &arrays[1], nullptr};
  mimetra_data* made = nullptr;
  mimetra_status status = m->new_data(m->job_context(job), MIMETRA_SEQUENCE, "made", list, &made);
  if (status == MIMETRA_OK) status = m->job_output(job, "out", made);
  m->free_data(made);
  return status;
}

mimetra_status run(const mimetra_interface* m, mimetra_job* job, void* user) {
  const std::string_view how = m->job_text(job, "how");
  if (how == "throw") throw std::runtime_error("of the plugin");
  if (how == "throw-number") throw 42;
  if (how == "throw-memory") throw std::bad_alloc();
  if (how == "status") return 77;
  if (how == "silent") return MIMETRA_MISMATCH;
  if (how == "refuse") return m->job_fail(job, MIMETRA_MISMATCH, "one eye is closed");
  if (how == "cancel") return MIMETRA_CANCELLED;
  if (how == "nothing") return MIMETRA_OK;
  if (how == "nan") return make(m, job, std::nan(""), "positions");
  if (how == "name") return make(m, job, 0, "postions");
  if (how == "ignored-nan") {
    make(m, job, std::nan(""), "positions");
    return MIMETRA_OK;
  }
  if (how == "twice") make(m, job, 0, "positions");
  if (how == "kind") return m->job_output(job, "table", m->job_input(job, "sequence", 0));
  if (how == "report") return m->job_report(job, "{\"a\": ", "");
  if (how == "no-utf8") return m->job_report(job, "{}", "\xff\xfe");
  if (how == "fail-in-no-utf8") return m->job_fail(job, MIMETRA_MISMATCH, "\xff!");
  if (how == "null") return m->job_output(job, nullptr, nullptr);
  if (how == "unknown") {
    const bool none = !m->job_input(job, "no", 0) && !m->job_input(job, "sequence", 5) &&
                      !m->job_text(job, "no") && std::isnan(m->job_number(job, "no")) &&
                      !m->job_wants(job, "no") && user == nullptr;
    if (!none) return MIMETRA_FAILED;
  }
  if (how == "throw-when-cancelled" && m->job_progress(job, 0) != MIMETRA_OK) {
    throw std::runtime_error(m->message(m->job_context(job)));
  }
  if (how == "fail-when-cancelled" && m->job_progress(job, 0) != MIMETRA_OK) {
    return m->job_fail(job, MIMETRA_FAILED, "could not go on");
  }
  if (how == "percent") {
    for (const double share : {50.0, -1.0, std::nan("")}) {
      if (m->job_progress(job, share) != MIMETRA_OK) return MIMETRA_FAILED;
    }
  }
  if (how == "radius") {
    m->job_report(
        job, ("{\"radius\": " + std::to_string(m->job_number(job, "radius")) + "}").c_str(), "");
  }
  return make(m, job, 0, "positions");
}

const mimetra_port kInput = {sizeof kInput, MIMETRA_SEQUENCE, "sequence", "anything", 0, 0};
const mimetra_port* const kInputs[] = {&kInput, nullptr};
const mimetra_port kOut = {sizeof kOut, MIMETRA_SEQUENCE, "out", "a triangle", 0, 0};
const mimetra_port kTable = {sizeof kTable, MIMETRA_TABLE, "table", "", MIMETRA_OPTIONAL, 0};
const mimetra_port* const kOutputs[] = {&kOut, &kTable, nullptr};
const mimetra_parameter kHow = {
    sizeof kHow, MIMETRA_TEXT, "how", "what goes wrong", "well", nullptr, 0, 0, nullptr, 0, 0};
const mimetra_parameter kRadius = {
    sizeof kRadius, MIMETRA_LENGTH, "radius", "a length", "0.5", nullptr, 0, 0, nullptr, 0, 0};
const mimetra_parameter* const kParameters[] = {&kHow, &kRadius, nullptr};
const mimetra_operation kOperation = {
    sizeof kOperation, 0,   "misbehave", "Does what is wrong", kInputs, kOutputs, kParameters,
    nullptr,           run, nullptr};
const mimetra_operation* const kOperations[] = {&kOperation, nullptr};
const mimetra_plugin kPlugin = {sizeof kPlugin, MIMETRA_INTERFACE_VERSION, "misbehaving",
                                kOperations, nullptr};

}  // namespace

const mimetra_plugin* mimetra_get_plugin() {
  return &kPlugin;
}
