/* Two threads with a context each run operations at once on one value: what one alone gets. */
#include <pthread.h>

#include <mimetra/plugins/c/mimetra.h>

#include "tests/c/programs/take.h"

enum { RUNS = 5 };

typedef struct {
  const mimetra_interface* m;
  const mimetra_data* take;
  const char* operation;
  const char* array;
  mimetra_data* result;
} task;

static mimetra_data* run(const task* task, mimetra_context* context) {
  const mimetra_interface* m = task->m;
  mimetra_call* call = NULL;
  mimetra_data* result = NULL;
  const mimetra_array* shown = NULL;
  OK(context, m->new_call(context, task->operation, &call));
  OK(context, m->call_give(call, "sequence", task->take));
  OK(context, m->call_set(call, "k", "3"));
  OK(context, m->call_run(call));
  OK(context, m->call_output(call, "out", 0, &result));
  OK(context, m->data_array(context, task->take, "positions", &shown));
  m->free_call(call);
  return result;
}

static void* work(void* given) {
  task* task_ = given;
  const mimetra_interface* m = task_->m;
  for (int i = 0; i < RUNS; ++i) {
    mimetra_context* context = NULL;
    CHECK(m->new_context(NULL, NULL, &context) == MIMETRA_OK);
    OK(context, m->set_threads(context, i % 2));
    m->free_data(task_->result);
    task_->result = run(task_, context);
    m->free_context(context);
  }
  return NULL;
}

static void check_equal(const task* a, const task* b, mimetra_context* context) {
  const mimetra_interface* m = a->m;
  const mimetra_array *left = NULL, *right = NULL;
  OK(context, m->data_array(context, a->result, a->array, &left));
  OK(context, m->data_array(context, b->result, b->array, &right));
  size_t bytes = left->type == MIMETRA_F64 ? 8 : 1;
  for (int d = 0; d < left->rank; ++d) {
    CHECK(left->shape[d] == right->shape[d]);
    bytes *= (size_t)left->shape[d];
  }
  CHECK(memcmp(left->values, right->values, bytes) == 0);
}

int main(void) {
  const mimetra_interface* m = mimetra_get_interface(MIMETRA_INTERFACE_VERSION);
  mimetra_context* context = NULL;
  CHECK(m && m->new_context(NULL, NULL, &context) == MIMETRA_OK);
  mimetra_data* take = take_of(m, context);
  task tasks[] = {{m, take, "decompose", "displacements", NULL},
                  {m, take, "regions", "masks", NULL}};
  pthread_t threads[2];
  for (int i = 0; i < 2; ++i) CHECK(pthread_create(&threads[i], NULL, work, &tasks[i]) == 0);
  for (int i = 0; i < 2; ++i) CHECK(pthread_join(threads[i], NULL) == 0);
  for (int i = 0; i < 2; ++i) {
    task alone = tasks[i];
    alone.result = run(&alone, context);
    check_equal(&tasks[i], &alone, context);
    m->free_data(alone.result);
    m->free_data(tasks[i].result);
  }
  m->free_data(take);
  m->free_context(context);
  return 0;
}
