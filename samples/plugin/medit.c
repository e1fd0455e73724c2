/* A plugin in C99 for the format `.mesh`, a text format that finite element tools share (Medit,
 * Gmsh, FreeFem). Build it as a shared library in a folder of MIMETRA_PLUGIN_PATH. Every operation
 * then reads and writes such triangle meshes: mimetra convert face.mesh -o face.obj */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <mimetra/plugins/c/mimetra.h>

typedef struct mesh {
  int vertices, triangles;
  double* positions; /* vertices x 3 */
  int32_t* corners;  /* triangles x 3, 0-based */
} mesh;

static void free_mesh(mesh* it) {
  free(it->positions);
  free(it->corners);
}

/* Reads `count` and allocates three numbers for each; fails if the file is too short for them. */
static void* counted(FILE* file, int* count, size_t size) {
  const long here = ftell(file);
  if (fscanf(file, "%d", count) != 1 || *count < 1 || fseek(file, 0, SEEK_END)) return NULL;
  const long bytes = ftell(file);
  if (*count > bytes || fseek(file, here, SEEK_SET) || fscanf(file, "%d", count) != 1) return NULL;
  return calloc((size_t)*count, 3 * size);
}

/* Returns the defect of a section, or NULL. The label at the end of each line is skipped. */
static const char* read_vertices(FILE* file, mesh* it) {
  if (it->positions) return "has Vertices twice";
  it->positions = (double*)counted(file, &it->vertices, sizeof(double));
  if (!it->positions) return "has no number after Vertices that it could hold";
  for (int v = 0; v < it->vertices; ++v) {
    double* xyz = it->positions + 3 * v;
    if (fscanf(file, "%lf %lf %lf %*d", xyz, xyz + 1, xyz + 2) != 3) return "ends in its Vertices";
  }
  return NULL;
}

static const char* read_triangles(FILE* file, mesh* it) {
  if (it->corners) return "has Triangles twice";
  it->corners = (int32_t*)counted(file, &it->triangles, sizeof(int32_t));
  if (!it->corners) return "has no number after Triangles that it could hold";
  for (int t = 0; t < it->triangles; ++t) {
    for (int c = 0; c < 3; ++c) {
      int corner = 0;
      if (fscanf(file, "%d", &corner) != 1) return "ends in its Triangles";
      it->corners[3 * t + c] = corner - 1;
    }
    fscanf(file, "%*d");
  }
  return NULL;
}

static const char* read_sections(FILE* file, mesh* it) {
  char word[64];
  const char* problem = NULL;
  int dimension = 3, version = 0;
  while (!problem && fscanf(file, "%63s", word) == 1 && strcmp(word, "End") != 0) {
    if (strcmp(word, "MeshVersionFormatted") == 0) {
      if (fscanf(file, "%d", &version) != 1) problem = "has no version";
    } else if (strcmp(word, "Dimension") == 0) {
      if (fscanf(file, "%d", &dimension) != 1 || dimension != 3) problem = "is not 3-dimensional";
    } else if (strcmp(word, "Vertices") == 0) {
      problem = read_vertices(file, it);
    } else if (strcmp(word, "Triangles") == 0) {
      problem = read_triangles(file, it);
    } else {
      problem = "has a section besides Vertices and Triangles, expected a triangle mesh";
    }
  }
  if (!problem && version == 0) problem = "does not begin with MeshVersionFormatted";
  if (!problem && (!it->positions || !it->corners)) problem = "has no Vertices or no Triangles";
  return problem;
}

static mimetra_status hand_over(const mimetra_interface* m, mimetra_job* job, const mesh* it) {
  const mimetra_array positions = {sizeof positions, MIMETRA_F64,  2, 0, {it->vertices, 3},
                                   "positions",      it->positions};
  const mimetra_array triangles = {sizeof triangles,   MIMETRA_I32, 2,          0,
                                   {it->triangles, 3}, "triangles", it->corners};
  const mimetra_array* const arrays[] = {&positions, &triangles, NULL};
  mimetra_data* value = NULL;
  mimetra_status status =
      m->new_data(m->job_context(job), MIMETRA_SEQUENCE, m->job_text(job, "path"), arrays, &value);
  if (status == MIMETRA_OK) status = m->job_output(job, "value", value);
  m->free_data(value);
  return status;
}

static mimetra_status read_mesh(const mimetra_interface* m, mimetra_job* job, void* user) {
  (void)user;
  FILE* file = fopen(m->job_text(job, "path"), "r");
  if (!file) return m->job_fail(job, MIMETRA_BAD_INPUT, "cannot be opened");
  mesh it = {0, 0, NULL, NULL};
  const char* problem = read_sections(file, &it);
  fclose(file);
  const mimetra_status status =
      problem ? m->job_fail(job, MIMETRA_BAD_INPUT, problem) : hand_over(m, job, &it);
  free_mesh(&it);
  return status;
}

static mimetra_status write_mesh(const mimetra_interface* m, mimetra_job* job, void* user) {
  (void)user;
  mimetra_context* context = m->job_context(job);
  const mimetra_data* value = m->job_input(job, "value", 0);
  const mimetra_array *positions = NULL, *triangles = NULL;
  mimetra_status status = m->data_array(context, value, "positions", &positions);
  if (status == MIMETRA_OK) status = m->data_array(context, value, "triangles", &triangles);
  if (status != MIMETRA_OK) return status;
  if (positions->shape[0] != 1) {
    return m->job_fail(job, MIMETRA_MISMATCH, "holds one frame; take one by --frames");
  }
  FILE* file = fopen(m->job_text(job, "path"), "w");
  if (!file) return m->job_fail(job, MIMETRA_BAD_OUTPUT, "cannot be written");
  fprintf(file, "MeshVersionFormatted 2\nDimension 3\nVertices\n%lld\n",
          (long long)positions->shape[1]);
  const double* xyz = (const double*)positions->values;
  for (int64_t v = 0; v < positions->shape[1]; ++v, xyz += 3) {
    fprintf(file, "%.17g %.17g %.17g 0\n", xyz[0], xyz[1], xyz[2]);
  }
  fprintf(file, "Triangles\n%lld\n", (long long)triangles->shape[0]);
  const int32_t* corners = (const int32_t*)triangles->values;
  for (int64_t t = 0; t < triangles->shape[0]; ++t, corners += 3) {
    fprintf(file, "%d %d %d 0\n", corners[0] + 1, corners[1] + 1, corners[2] + 1);
  }
  fprintf(file, "End\n");
  const int failed = ferror(file);
  if (fclose(file) || failed) return m->job_fail(job, MIMETRA_BAD_OUTPUT, "cannot be written");
  return MIMETRA_OK;
}

static const char* const extensions[] = {".mesh", NULL};
static const mimetra_format format = {.struct_size = sizeof format,
                                      .kind = MIMETRA_SEQUENCE,
                                      .name = "Medit mesh of one frame",
                                      .extensions = extensions,
                                      .read = read_mesh,
                                      .write = write_mesh};
static const mimetra_format* const formats[] = {&format, NULL};
static const mimetra_plugin plugin = {.struct_size = sizeof plugin,
                                      .version = MIMETRA_INTERFACE_VERSION,
                                      .name = "medit sample",
                                      .formats = formats};

MIMETRA_EXPORT const mimetra_plugin* mimetra_get_plugin(void) {
  return &plugin;
}
