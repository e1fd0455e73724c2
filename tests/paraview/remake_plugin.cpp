// Operations that make something else than the mesh they were given; a parameter chooses what.

#include <string_view>
#include <vector>

#include "plugins/c/mimetra.h"

namespace {

using Arrays = std::vector<const mimetra_array*>;

mimetra_array integers(const char* name, const std::vector<std::int32_t>& values) {
  const auto count = static_cast<std::int64_t>(values.size());
  return {sizeof(mimetra_array), MIMETRA_I32, 1, 0, {count, 0, 0, 0}, name, values.data()};
}

class Remake {
 public:
  Remake(const mimetra_interface* m, mimetra_job* job)
      : m_(m), job_(job), context_(m->job_context(job)), given_(m->job_input(job, "sequence", 0)) {}

  mimetra_status run(std::string_view how) const {
    const double none = 0;
    const mimetra_array column = {sizeof column, MIMETRA_F64, 1, 0, {1, 0, 0, 0}, "column", &none};
    hand_over("rows", MIMETRA_TABLE, {&column});
    if (how == "triangles") return triangles();
    if (how == "turned") return turned();
    if (how == "halved") return halved();
    if (how == "doubled") return doubled();
    const bool is_asked = m_->job_wants(job_, "out") && m_->job_wants(job_, "rows");
    if (how == "asked" && is_asked) return m_->job_output(job_, "out", given_);
    return MIMETRA_OK;
  }

 private:
  const mimetra_array* array(const char* name) const {
    const mimetra_array* found = nullptr;
    m_->data_array(context_, given_, name, &found);
    return found;
  }

  mimetra_status hand_over(const char* output, mimetra_kind kind, Arrays arrays) const {
    arrays.push_back(nullptr);
    mimetra_data* made = nullptr;
    mimetra_status status = m_->new_data(context_, kind, "made", arrays.data(), &made);
    if (status == MIMETRA_OK) status = m_->job_output(job_, output, made);
    m_->free_data(made);
    return status;
  }

  /// The triangles of the polygons, each with its index.
  mimetra_status triangles() const {
    const mimetra_array* faces = array("triangles");
    std::vector<std::int32_t> indices;
    for (std::int32_t t = 0; t < faces->shape[0]; ++t) indices.push_back(t);
    mimetra_array field = integers("index", indices);
    field.location = MIMETRA_ON_TRIANGLES;
    return hand_over("out", MIMETRA_SEQUENCE, {array("positions"), array("times"), faces, &field});
  }

  /// As many faces, which look the other way, and a field that ParaView's plugin also makes.
  mimetra_status turned() const {
    const mimetra_array* given = array("corners");
    const auto* corners = static_cast<const std::int32_t*>(given->values);
    const std::vector<std::int32_t> reversed(std::reverse_iterator(corners + given->shape[0]),
                                             std::reverse_iterator(corners));
    const mimetra_array turned = integers("corners", reversed);
    const std::vector<std::int32_t> sevens(static_cast<std::size_t>(array("positions")->shape[1]),
                                           7);
    mimetra_array field = integers("displacement", sevens);
    field.location = MIMETRA_ON_VERTICES;
    return hand_over("out", MIMETRA_SEQUENCE,
                     {array("positions"), array("times"), array("face_sizes"), &turned, &field});
  }

  /// Every second frame.
  mimetra_status halved() const {
    mimetra_array positions = *array("positions"), times = *array("times");
    const std::int64_t size = positions.shape[1] * 3, count = (positions.shape[0] + 1) / 2;
    const auto* all = static_cast<const double*>(positions.values);
    const auto* seconds = static_cast<const double*>(times.values);
    std::vector<double> kept, when;
    for (std::int64_t f = 0; f < count; ++f) {
      kept.insert(kept.end(), all + 2 * f * size, all + (2 * f + 1) * size);
      when.push_back(seconds[2 * f]);
    }
    positions.shape[0] = times.shape[0] = count;
    positions.values = kept.data();
    times.values = when.data();
    return hand_over("out", MIMETRA_SEQUENCE,
                     {&positions, &times, array("face_sizes"), array("corners")});
  }

  /// The field "height", twice as large.
  mimetra_status doubled() const {
    const mimetra_array* given = array("height");
    if (!given) return m_->job_fail(job_, MIMETRA_MISMATCH, "there is no field height");
    const auto* heights = static_cast<const double*>(given->values);
    std::vector<double> twice;
    for (std::int64_t v = 0; v < given->shape[0]; ++v) twice.push_back(2 * heights[v]);
    mimetra_array field = *given;
    field.values = twice.data();
    return hand_over(
        "out", MIMETRA_SEQUENCE,
        {array("positions"), array("times"), array("face_sizes"), array("corners"), &field});
  }

  const mimetra_interface* m_;
  mimetra_job* job_;
  mimetra_context* context_;
  const mimetra_data* given_;
};

mimetra_status remake(const mimetra_interface* m, mimetra_job* job, void*) {
  return Remake(m, job).run(m->job_text(job, "operation"));
}

/// Hands on its second input.
mimetra_status replace(const mimetra_interface* m, mimetra_job* job, void*) {
  const mimetra_data* other = m->job_input(job, "other", 0);
  if (!other) return m->job_fail(job, MIMETRA_FAILED, "was called without an input it needs");
  return m->job_output(job, "out", other);
}

/// Hands on its sequence where the model has as many vertices.
mimetra_status follow(const mimetra_interface* m, mimetra_job* job, void*) {
  const mimetra_data* take = m->job_input(job, "sequence", 0);
  const mimetra_array *positions = nullptr, *neutral = nullptr;
  m->data_array(m->job_context(job), take, "positions", &positions);
  m->data_array(m->job_context(job), m->job_input(job, "actor", 0), "neutral", &neutral);
  if (positions->shape[1] != neutral->shape[0]) {
    return m->job_fail(job, MIMETRA_MISMATCH, "the actor has other vertices");
  }
  return m->job_output(job, "out", take);
}

const mimetra_port fields = {sizeof fields, MIMETRA_SEQUENCE,    "sequence",
                             "a take",      MIMETRA_WITH_FIELDS, 0};
const mimetra_port sequence = {sizeof sequence, MIMETRA_SEQUENCE, "sequence", "a take", 0, 0};
const mimetra_port other = {sizeof other, MIMETRA_SEQUENCE, "other", "the other take", 0, 0};
const mimetra_port actor = {sizeof actor, MIMETRA_MODEL, "actor", "who follows", 0, 0};
const mimetra_port asked = {
    sizeof asked, MIMETRA_SEQUENCE, "out", "mesh", MIMETRA_OPTIONAL | MIMETRA_WITH_FIELDS, 0};
const mimetra_port made = {sizeof made, MIMETRA_SEQUENCE, "out", "mesh", 0, 0};
const mimetra_port rows = {sizeof rows, MIMETRA_TABLE, "rows", "a table", 0, 0};
const mimetra_port* const remake_inputs[] = {&fields, nullptr};
const mimetra_port* const remake_outputs[] = {&asked, &rows, nullptr};
const mimetra_port* const replace_inputs[] = {&sequence, &other, nullptr};
const mimetra_port* const follow_inputs[] = {&sequence, &actor, nullptr};
const mimetra_port* const replace_outputs[] = {&made, nullptr};

const char* const ways[] = {"triangles", "turned",  "halved", "doubled",
                            "asked",     "nothing", nullptr};
const mimetra_parameter how = {
    sizeof how, MIMETRA_CHOICE, "operation", "what to do", "asked", nullptr, 0, 0, ways, 0, 0};
const mimetra_parameter hint = {
    sizeof hint, MIMETRA_CHOICE, "hint", "no default", nullptr, nullptr, 0, 0, ways, 0, 0};
const mimetra_parameter value = {sizeof value,
                                 MIMETRA_INTEGER,
                                 "input",
                                 "called as the port",
                                 "7",
                                 nullptr,
                                 0,
                                 0,
                                 nullptr,
                                 0,
                                 0};
const mimetra_parameter* const parameters[] = {&how, &hint, &value, nullptr};
const mimetra_operation remake_operation = {sizeof remake_operation,
                                            0,
                                            "remake",
                                            "Make something else",
                                            remake_inputs,
                                            remake_outputs,
                                            parameters,
                                            nullptr,
                                            remake,
                                            nullptr};
const mimetra_operation replace_operation = {sizeof replace_operation,
                                             0,
                                             "replace",
                                             "Take another one",
                                             replace_inputs,
                                             replace_outputs,
                                             nullptr,
                                             nullptr,
                                             replace,
                                             nullptr};
const mimetra_operation follow_operation = {sizeof follow_operation,
                                            0,
                                            "follow",
                                            "Look at a model",
                                            follow_inputs,
                                            replace_outputs,
                                            nullptr,
                                            nullptr,
                                            follow,
                                            nullptr};
// It would be called as ParaView's source is.
const mimetra_operation taken = {
    sizeof taken, 0,       "sequence", "Take another one", replace_inputs, replace_outputs, nullptr,
    nullptr,      replace, nullptr};
const mimetra_operation* const operations[] = {&remake_operation, &replace_operation,
                                               &follow_operation, &taken, nullptr};
const mimetra_plugin plugin = {sizeof plugin, MIMETRA_INTERFACE_VERSION, "remake", operations,
                               nullptr};

}  // namespace

const mimetra_plugin* mimetra_get_plugin() {
  return &plugin;
}
