// Operations on kinds of values, and numbers of them, that none of the toolkit takes or makes.

#include <cstdint>
#include <string>
#include <vector>

#include "plugins/c/mimetra.h"

namespace {

/// Makes regions for a sequence: the first vertex of its first triangle.
mimetra_status make_spot(const mimetra_interface* m, mimetra_job* job,
                         const mimetra_data* sequence) {
  mimetra_context* context = m->job_context(job);
  const mimetra_array *triangles = nullptr, *positions = nullptr;
  mimetra_status status = m->data_array(context, sequence, "triangles", &triangles);
  if (status == MIMETRA_OK) status = m->data_array(context, sequence, "positions", &positions);
  if (status != MIMETRA_OK) return status;
  const std::int64_t vertices = positions->shape[1];
  std::vector<std::uint8_t> inside(static_cast<std::size_t>(vertices));
  const auto* corners = static_cast<const std::int32_t*>(triangles->values);
  inside[static_cast<std::size_t>(corners[0])] = 1;
  const mimetra_array masks = {sizeof masks, MIMETRA_U8,   2, 0, {1, vertices, 0, 0},
                               "masks",      inside.data()};
  const mimetra_array* const arrays[] = {&masks, triangles, nullptr};
  mimetra_data* regions = nullptr;
  status = m->new_data(context, MIMETRA_REGIONS, "spots", arrays, &regions);
  if (status == MIMETRA_OK) status = m->job_output(job, "out", regions);
  m->free_data(regions);
  return status;
}

mimetra_status spots(const mimetra_interface* m, mimetra_job* job, void*) {
  return make_spot(m, job, m->job_input(job, "sequence", 0));
}

mimetra_status spot_each(const mimetra_interface* m, mimetra_job* job, void*) {
  mimetra_status status = MIMETRA_OK;
  for (std::int32_t i = 0; status == MIMETRA_OK; ++i) {
    const mimetra_data* sequence = m->job_input(job, "sequences", i);
    if (!sequence) break;
    status = make_spot(m, job, sequence);
  }
  return status;
}

/// Says how many vertices its regions have.
mimetra_status count(const mimetra_interface* m, mimetra_job* job, void*) {
  const mimetra_array* masks = nullptr;
  const mimetra_data* regions = m->job_input(job, "regions", 0);
  const mimetra_status status = m->data_array(m->job_context(job), regions, "masks", &masks);
  if (status != MIMETRA_OK) return status;
  const std::string vertices = std::to_string(masks->shape[1]);
  return m->job_report(job, ("{\"vertices\": " + vertices + "}").c_str(), "");
}

/// Hands every sequence back.
mimetra_status each(const mimetra_interface* m, mimetra_job* job, void*) {
  for (std::int32_t i = 0;; ++i) {
    const mimetra_data* sequence = m->job_input(job, "sequences", i);
    if (!sequence) return MIMETRA_OK;
    const mimetra_status status = m->job_output(job, "out", sequence);
    if (status != MIMETRA_OK) return status;
  }
}

constexpr auto kPort = sizeof(mimetra_port);
const mimetra_port kSequence = {kPort, MIMETRA_SEQUENCE, "sequence", "a mesh", 0, 0};
const mimetra_port kSequences = {kPort, MIMETRA_SEQUENCE, "sequences", "", MIMETRA_REPEATED, 0};
const mimetra_port kRegions = {kPort, MIMETRA_REGIONS, "out", "a vertex", 0, 0};
const mimetra_port kCopies = {kPort, MIMETRA_SEQUENCE, "out", "", MIMETRA_REPEATED, 0};
const mimetra_port* const kSpotsInputs[] = {&kSequence, nullptr};
const mimetra_port* const kSpotsOutputs[] = {&kRegions, nullptr};
const mimetra_port* const kEachInputs[] = {&kSequences, nullptr};
const mimetra_port* const kEachOutputs[] = {&kCopies, nullptr};
const mimetra_port kSpotCopies = {kPort, MIMETRA_REGIONS, "out", "", MIMETRA_REPEATED, 0};
const mimetra_port kFields = {kPort, MIMETRA_SEQUENCE, "fields", "", MIMETRA_WITH_FIELDS, 0};
const mimetra_port kASet = {kPort, MIMETRA_REGIONS, "regions", "", MIMETRA_NAMED, 0};
const mimetra_port* const kSpotEachOutputs[] = {&kSpotCopies, nullptr};
const mimetra_port* const kCountInputs[] = {&kFields, &kASet, nullptr};
const mimetra_parameter kSeed = {sizeof kSeed, MIMETRA_INTEGER, "seed", "unused", "0", nullptr, 0,
                                 4294967295,   nullptr,         0,      0};
const mimetra_parameter* const kParameters[] = {&kSeed, nullptr};
constexpr auto kSize = sizeof(mimetra_operation);
const mimetra_operation kAll[] = {{kSize, 0, "spots", "Makes regions", kSpotsInputs, kSpotsOutputs,
                                   kParameters, nullptr, spots, nullptr},
                                  {kSize, 0, "spot-each", "Makes regions of several", kEachInputs,
                                   kSpotEachOutputs, nullptr, nullptr, spot_each, nullptr},
                                  {kSize, 0, "count", "Takes regions of fields", kCountInputs,
                                   nullptr, nullptr, nullptr, count, nullptr},
                                  {kSize, 0, "each", "Takes several", kEachInputs, kEachOutputs,
                                   nullptr, nullptr, each, nullptr}};
const mimetra_operation* const kOperations[] = {&kAll[0], &kAll[1], &kAll[2], &kAll[3], nullptr};
const mimetra_plugin kPlugin = {sizeof kPlugin, MIMETRA_INTERFACE_VERSION, "kinds", kOperations,
                                nullptr};

}  // namespace

const mimetra_plugin* mimetra_get_plugin() {
  return &kPlugin;
}
