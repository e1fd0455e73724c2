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
const mimetra_port sequence = {kPort, MIMETRA_SEQUENCE, "sequence", "a mesh", 0, 0};
const mimetra_port sequences = {kPort, MIMETRA_SEQUENCE, "sequences", "", MIMETRA_REPEATED, 0};
const mimetra_port regions = {kPort, MIMETRA_REGIONS, "out", "a vertex", 0, 0};
const mimetra_port copies = {kPort, MIMETRA_SEQUENCE, "out", "", MIMETRA_REPEATED, 0};
const mimetra_port* const spots_inputs[] = {&sequence, nullptr};
const mimetra_port* const spots_outputs[] = {&regions, nullptr};
const mimetra_port* const each_inputs[] = {&sequences, nullptr};
const mimetra_port* const each_outputs[] = {&copies, nullptr};
const mimetra_port spot_copies = {kPort, MIMETRA_REGIONS, "out", "", MIMETRA_REPEATED, 0};
const mimetra_port fields = {kPort, MIMETRA_SEQUENCE, "fields", "", MIMETRA_WITH_FIELDS, 0};
const mimetra_port a_set = {kPort, MIMETRA_REGIONS, "regions", "", MIMETRA_NAMED, 0};
const mimetra_port* const spot_each_outputs[] = {&spot_copies, nullptr};
const mimetra_port* const count_inputs[] = {&fields, &a_set, nullptr};
const mimetra_parameter seed = {sizeof seed, MIMETRA_INTEGER, "seed",  "unused", "0", nullptr,
                                0,           4294967295,      nullptr, 0,        0};
const mimetra_parameter* const parameters[] = {&seed, nullptr};
constexpr auto kSize = sizeof(mimetra_operation);
const mimetra_operation all[] = {{kSize, 0, "spots", "Makes regions", spots_inputs, spots_outputs,
                                  parameters, nullptr, spots, nullptr},
                                 {kSize, 0, "spot-each", "Makes regions of several", each_inputs,
                                  spot_each_outputs, nullptr, nullptr, spot_each, nullptr},
                                 {kSize, 0, "count", "Takes regions of fields", count_inputs,
                                  nullptr, nullptr, nullptr, count, nullptr},
                                 {kSize, 0, "each", "Takes several", each_inputs, each_outputs,
                                  nullptr, nullptr, each, nullptr}};
const mimetra_operation* const operations[] = {&all[0], &all[1], &all[2], &all[3], nullptr};
const mimetra_plugin plugin = {sizeof plugin, MIMETRA_INTERFACE_VERSION, "kinds", operations,
                               nullptr};

}  // namespace

const mimetra_plugin* mimetra_get_plugin() {
  return &plugin;
}
