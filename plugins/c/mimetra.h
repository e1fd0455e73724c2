/*
 * mimetra.h: the C interface of mimetra. Mesh tools call the toolkit's operations through it, and
 * shared libraries add operations of their own. This header is its manual; it is C99 and C++.
 *
 * A program links libmimetra_c, or loads it, and asks for the table of functions:
 *
 *   const mimetra_interface* m = mimetra_get_interface(MIMETRA_INTERFACE_VERSION);
 *   mimetra_context* context;
 *   if (!m || m->new_context(NULL, NULL, &context) != MIMETRA_OK) return 1;
 *
 *   // A take of F frames and N vertices, as the host holds it.
 *   mimetra_array positions = {sizeof positions, MIMETRA_F64, 3, 0, {F, N, 3}, "positions", xyz};
 *   mimetra_array triangles = {sizeof triangles, MIMETRA_I32, 2, 0, {T, 3}, "triangles", corners};
 *   const mimetra_array* arrays[] = {&positions, &triangles, NULL};
 *   mimetra_data* take = NULL;
 *   mimetra_call* call = NULL;
 *   mimetra_data* result = NULL;
 *   const mimetra_array* moved = NULL;
 *   if (m->new_data(context, MIMETRA_SEQUENCE, "take", arrays, &take) ||
 *       m->new_call(context, "transfer", &call) ||
 *       m->call_give(call, "source", take) ||
 *       m->call_read(call, "target", "actor@identity001=1") ||
 *       m->call_set(call, "k", "30") ||
 *       m->call_run(call) ||
 *       m->call_output(call, "out", 0, &result) ||
 *       m->data_array(context, result, "positions", &moved)) {
 *     fprintf(stderr, "%s\n", m->message(context));
 *   } else {
 *     use((const double*)moved->values, moved->shape);  // F, vertices of the actor, 3
 *   }
 *   m->free_data(result);
 *   m->free_call(call);
 *   m->free_data(take);
 *   m->free_context(context);
 *
 * Versions. A library that returns NULL does not serve that version of the header. A library that
 *   serves a version will always serve it. Within a version, structs grow at their end only. Set
 *   struct_size in every struct that you make or copy; fields past it count as zero. A program that
 *   must run with an older library checks MIMETRA_HAS(m, function) before it calls a function that
 *   was added later.
 *
 * Errors. Functions that can fail return a mimetra_status, which is the exit code of the command in
 *   the same case. Their results are then NULL, and m->message(context) describes the error for
 *   users. NULL instead of a handle is MIMETRA_USAGE. No C++ exception leaves a function, and none
 *   may leave a callback.
 *
 * Who frees what. You own handles that a function returns through a pointer (mimetra_context**,
 *   mimetra_data**, mimetra_call**). Free them with the free_... function of their kind, which
 *   accepts NULL. Anything behind a pointer to const (text, descriptions, arrays) belongs to the
 *   handle that returned it. It lives as long as that handle unless noted otherwise. Arguments are
 *   copied, so you may free them when the function returns.
 *
 * Threads. A context, with its calls, serves one thread at a time; several contexts serve several
 *   threads at once. A job serves the thread that called run, and no exception may leave a thread
 *   that run has started. Values (mimetra_data) belong to no context and never change: any number
 *   of threads may read one and give it to calls. Callbacks come from the thread that called.
 *   Inside, an operation uses as many threads as m->set_threads() allows; results do not depend on
 *   it.
 *
 * Text is UTF-8 and ends with 0. Lists end with NULL. Arrays are in C order, without gaps.
 */
#ifndef MIMETRA_H
#define MIMETRA_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MIMETRA_INTERFACE_VERSION 1

#if defined(_WIN32)
#define MIMETRA_EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define MIMETRA_EXPORT __attribute__((visibility("default")))
#else
#define MIMETRA_EXPORT
#endif

/* ---- Constants ------------------------------------------------------------------------------ */

typedef int32_t mimetra_status;
enum {
  MIMETRA_OK = 0,
  MIMETRA_FAILED = 1,     /* the computation failed */
  MIMETRA_USAGE = 2,      /* the request is wrong whatever the data */
  MIMETRA_BAD_INPUT = 3,  /* an input is wrong in itself */
  MIMETRA_MISMATCH = 4,   /* inputs contradict each other or the request */
  MIMETRA_BAD_OUTPUT = 5, /* an output cannot be written, or exists */
  MIMETRA_CANCELLED = 130 /* the progress function returned 0 */
};

/* Kinds of values. Their arrays are listed at mimetra_data. */
typedef int32_t mimetra_kind;
enum {
  MIMETRA_SEQUENCE = 1,
  MIMETRA_MODEL = 2,
  MIMETRA_COMPONENTS = 3,
  MIMETRA_REGIONS = 4,
  MIMETRA_TABLE = 5,
  MIMETRA_LANDMARKS = 6,
  MIMETRA_FIT = 7,
  MIMETRA_PICTURES = 8,
  MIMETRA_DOCUMENT = 9
};

/* Kinds of parameters, and how their values are written as text. */
typedef int32_t mimetra_parameter_kind;
enum {
  MIMETRA_FLAG = 1,         /* "true" or "false" */
  MIMETRA_INTEGER = 2,      /* "30", of 32 bits */
  MIMETRA_INTEGER_LIST = 3, /* "10,30,40" */
  MIMETRA_NUMBER = 4,       /* "0.5" */
  MIMETRA_LENGTH = 5,       /* "0.1" of the rest pose's diameter, or "12abs" */
  MIMETRA_CHOICE = 6,       /* one of the choices */
  MIMETRA_TEXT = 7,
  MIMETRA_FILE = 8 /* a path, or one of the choices */
};

/* Types of an array's elements. */
enum {
  MIMETRA_F64 = 1,
  MIMETRA_F32 = 2, /* accepted; results are F64 */
  MIMETRA_I32 = 3,
  MIMETRA_U8 = 4,
  MIMETRA_STRING = 5 /* const char* */
};

/* Location of an array's entries: nowhere on the mesh, one per vertex, one per triangle. */
enum { MIMETRA_NOWHERE = 0, MIMETRA_ON_VERTICES = 1, MIMETRA_ON_TRIANGLES = 2 };

enum { MIMETRA_INFO = 0, MIMETRA_WARNING = 1 };

/* Flags of mimetra_port. */
enum {
  MIMETRA_OPTIONAL = 1,
  MIMETRA_REPEATED = 2,   /* one value or more; an output has one for each of the repeated input */
  MIMETRA_NAMED = 4,      /* the command takes it as --NAME although it is needed */
  MIMETRA_WITH_FIELDS = 8 /* a sequence whose fields matter: files that hold them are written */
};

/* Flags of mimetra_parameter for parameters of files. A call accepts parameters of reading if it
 * reads an input from a file to which they apply, and parameters of writing if it writes such an
 * output. load_data accepts the former, save_data the latter. */
enum { MIMETRA_READING = 1, MIMETRA_WRITING = 2 };

/* ---- Callbacks ------------------------------------------------------------------------------ */

/* Share of the work done, in [0, 1]. Return 0 to cancel. */
typedef int32_t (*mimetra_progress)(double share, void* user);

/* One line for the user; level is MIMETRA_INFO or MIMETRA_WARNING. */
typedef void (*mimetra_log)(int32_t level, const char* text, void* user);

/* ---- Values --------------------------------------------------------------------------------- */

typedef struct mimetra_array {
  uint32_t struct_size;
  int32_t type;     /* MIMETRA_F64, ... */
  int32_t rank;     /* 1 to 4 */
  int32_t location; /* for fields: MIMETRA_ON_VERTICES or MIMETRA_ON_TRIANGLES */
  int64_t shape[4];
  const char* name;
  const void* values;
} mimetra_array;

/*
 * A value: an input or output of operations. It is made from named arrays and shown as named
 * arrays. Sizes: N vertices, T triangles, P polygons, C polygon corners, F frames, K components, R
 * regions, D expressions, I identities, W weights. Arrays in [brackets] are optional when you make
 * a value. Arrays after a | are only shown.
 *
 *   faces       face_sizes I32 P and corners I32 C, or triangles I32 T x 3; both are shown |
 *               face_of_triangle I32 T
 *   sequence    positions F x N x 3 (or N x 3), faces, [times F], [rest N x 3], and any
 *               number of fields: N or N x c on vertices, T or T x c on triangles, by
 *               their location
 *   model       neutral N x 3, faces, [expressions D x N x 3, expression_names STRING D],
 *               [identities I x N x 3, identity_names STRING I]; for a performance weights F x W,
 *               weight_names STRING W, [times F]; [landmarks I32 L x 2: number, vertex].
 *               A model without expressions is a mesh
 *   components  rest N x 3, triangles, displacements K x N x 3, [weights F x K], centers I32 K
 *               (-1: it died), [support K x N], [energies], [scale 1], [d_min 1], [d_max 1]
 *   regions     masks U8 R x N, triangles or faces, [weight N on vertices: the share of the motion
 *               that each vertex takes, 0 to 1, if the border is soft; a derived value with other
 *               masks drops it] | centers I32 R, radii R, energies R, energy_shares R,
 *               vertex_energy N, faces of the mesh that shows them, colors U8 R x 3 if faces are
 *               known (sRGB, as in pictures and reports; light if the region is nowhere the
 *               strongest), and fields: region I32 N (strongest region, -1 outside), region_count
 *               I32 N, roi I32 N (0/1), in_L I32 T (0/1), ... Centers, radii and energies are
 *               meaningless for regions that were made or read
 *   table       one array R per column; NaN is an empty cell | one column of words, STRING R
 *   landmarks   points F x L x 2 (pixels, y down, NaN: not seen), names STRING L, [times F],
 *               [confidence F]
 *   fit         | alpha F x I, beta F x D, identity_names STRING I, expression_names STRING D,
 *               times F, cameras F x 2 x 4, rms F
 *   pictures    pixels U8 height x width x 3 of one picture, sRGB, from the top left | of several
 *               pictures pixels_0, pixels_1, ..., drawn on demand
 *   document    text STRING 1: a page, a script
 *
 * The default type is F64; F32 is accepted as well. Numbers must be finite, except in fields,
 * tables and the points of landmarks. Times are ascending seconds. Only fields have a location. Two
 * fields may share a name if one is on vertices and one on triangles; data_array() then returns the
 * first.
 *
 * Among tables, only weights can be read from files. Pictures and fits cannot be read from files;
 * give them to calls as values.
 */
typedef struct mimetra_data mimetra_data;

/* ---- Operations ----------------------------------------------------------------------------- */

/*
 * Names of operations, inputs, outputs and parameters consist of small letters, digits and '-', and
 * begin with a letter. All inputs, outputs and parameters of an operation have different names. A
 * name must not be an option of every command (h help q quiet v verbose o json progress threads
 * config force dry-run). It must not be a parameter of reading the operation's inputs or writing
 * its outputs either (of_files: frames, fps, weights, topology, format, ...). The command writes
 * the output "out" with -o. Choices consist of letters, digits, '-', '_' and '.', and do not begin
 * with '-'. Only the last input that is neither optional nor named can be repeated.
 */

/* An input or output. */
typedef struct mimetra_port {
  uint32_t struct_size;
  mimetra_kind kind;
  const char* name;
  const char* help; /* one line */
  uint32_t flags;   /* MIMETRA_OPTIONAL | ... */
  uint32_t reserved;
} mimetra_port;

typedef struct mimetra_parameter {
  uint32_t struct_size;
  mimetra_parameter_kind kind;
  const char* name;           /* "radius" */
  const char* help;           /* one line */
  const char* fallback;       /* the default as text; NULL for none */
  const char* unit;           /* NULL for none */
  double minimum;             /* for numbers and lengths; -INFINITY and INFINITY are open ends */
  double maximum;             /* no range unless it exceeds the minimum */
  const char* const* choices; /* NULL for none */
  uint32_t of_files;          /* MIMETRA_READING | MIMETRA_WRITING; 0: of the operation itself */
  uint32_t reserved;
} mimetra_parameter;

struct mimetra_interface;
typedef struct mimetra_job mimetra_job;

/* Runs a third-party operation; see mimetra_plugin. */
typedef mimetra_status (*mimetra_run)(const struct mimetra_interface* m, mimetra_job* job,
                                      void* user);

typedef struct mimetra_operation {
  uint32_t struct_size;
  uint32_t reserved;
  const char* name;    /* "transfer" */
  const char* summary; /* one line */
  const mimetra_port* const* inputs;
  const mimetra_port* const* outputs;
  const mimetra_parameter* const* parameters;
  const char* const* examples; /* command lines without the program's name */
  mimetra_run run;             /* NULL if an operation is only described */
  void* user;                  /* passed to run */
} mimetra_operation;

/*
 * A file format for one kind of value. A plugin's read and write run as an operation does, with a
 * job of their own: job_text(job, "path") is the file. read returns the value with job_output(job,
 * "value", data). write gets it from job_input(job, "value", 0). The path of write is a temporary
 * name; the file gets its final name when write returns MIMETRA_OK. Parameters may have any name
 * except "path" and the names that mimetra_operation excludes.
 */
typedef struct mimetra_format {
  uint32_t struct_size;
  mimetra_kind kind;
  const char* name;              /* one line: "PC2 point cache" */
  const char* const* extensions; /* ".pc2". The toolkit also has "" (a folder, a pattern, a name
                                  * with '@') and "*" (any file). A plugin's extension is a dot and
                                  * small letters, digits, '_' or '-', and not used by another
                                  * format of the kind */
  const mimetra_parameter* const* parameters; /* each with of_files */
  mimetra_run read;                           /* NULL if it is not read, or only described */
  mimetra_run write;                          /* NULL if it is not written, or only described */
  void* user;                                 /* passed to both */
  uint32_t flags;                             /* MIMETRA_WITH_FIELDS: a sequence keeps its fields */
  uint32_t use; /* MIMETRA_READING | MIMETRA_WRITING, in descriptions */
} mimetra_format;

/* An operation table with its plugins, settings, and the last error. */
typedef struct mimetra_context mimetra_context;

/* One operation with its inputs and parameters. */
typedef struct mimetra_call mimetra_call;

/* ---- Functions ------------------------------------------------------------------------------ */

typedef struct mimetra_interface {
  uint32_t struct_size;
  uint32_t version;            /* MIMETRA_INTERFACE_VERSION of this table */
  const char* toolkit_version; /* "0.2.0" */

  /* -- Contexts -- */

  /* Makes a context with the operations of the toolkit and of installed plugins (mimetra_plugin).
   * Plugins that cannot be used are reported to `log` and skipped. `log` may be NULL. */
  mimetra_status (*new_context)(mimetra_log log, void* user, mimetra_context** context);
  /* Free its calls first. */
  void (*free_context)(mimetra_context* context);
  /* Message of the last function that failed with this context. Valid until the next one fails. */
  const char* (*message)(const mimetra_context* context);
  /* Sets the progress function for everything that takes time; NULL for none. */
  mimetra_status (*set_progress)(mimetra_context* context, mimetra_progress progress, void* user);
  /* Sets the maximum number of threads, up to 1024; 0 for all there are. */
  mimetra_status (*set_threads)(mimetra_context* context, int32_t threads);

  /* -- Operations -- */

  /* All operations; a list that ends with NULL. */
  const mimetra_operation* const* (*operations)(const mimetra_context* context);
  /* NULL if no operation has that name. */
  const mimetra_operation* (*find_operation)(const mimetra_context* context, const char* name);
  /* All operations as a JSON array, as `mimetra operations --json` prints it. */
  mimetra_status (*operations_json)(mimetra_context* context, const char** json);

  /* -- Values -- */

  /* Makes a value from arrays. `name` appears in messages and names of outputs. */
  mimetra_status (*new_data)(mimetra_context* context, mimetra_kind kind, const char* name,
                             const mimetra_array* const* arrays, mimetra_data** data);
  /* Copies `base` with these arrays in place of its own. Data that no array shows, such as texture
   * coordinates, is kept. */
  mimetra_status (*derive_data)(mimetra_context* context, const mimetra_data* base,
                                const mimetra_array* const* arrays, mimetra_data** data);
  /* Reads a value from a file, a folder or anything else that the command accepts as an input of
   * that kind. `settings`: "frames=0:100", "fps=25", "weights=take.csv", "topology=mesh.ply"; NULL
   * for none. Region sets belong to a mesh: read them with call_read, for the call's first input
   * that has a mesh. */
  mimetra_status (*load_data)(mimetra_context* context, mimetra_kind kind, const char* text,
                              const char* const* settings, mimetra_data** data);
  /* Writes a value in the format of the path's extension, as the command does. `settings` are the
   * command's parameters of writing ("format=obj"), and "force=true" to replace an earlier result;
   * NULL for none. */
  mimetra_status (*save_data)(mimetra_context* context, const mimetra_data* data, const char* path,
                              const char* const* settings);
  void (*free_data)(mimetra_data* data);

  mimetra_kind (*data_kind)(const mimetra_data* data); /* 0 for NULL */
  const char* (*data_name)(const mimetra_data* data);
  /* All arrays of a value; a list that ends with NULL. */
  mimetra_status (*data_arrays)(mimetra_context* context, const mimetra_data* data,
                                const mimetra_array* const** arrays);
  /* One array. MIMETRA_USAGE if there is none of that name; the message lists all arrays. */
  mimetra_status (*data_array)(mimetra_context* context, const mimetra_data* data, const char* name,
                               const mimetra_array** array);
  /* Contents of the .json file for regions, tables and fits; kind, name and arrays for others. */
  mimetra_status (*data_json)(mimetra_context* context, const mimetra_data* data,
                              const char** json);

  /* -- Calls: first the inputs, then call_run, then the outputs -- */

  mimetra_status (*new_call)(mimetra_context* context, const char* operation, mimetra_call** call);
  void (*free_call)(mimetra_call* call);
  /* Sets a parameter from text; NULL restores its default. */
  mimetra_status (*call_set)(mimetra_call* call, const char* parameter, const char* text);
  /* Sets the value of an input, or adds a value to a repeated input. */
  mimetra_status (*call_give)(mimetra_call* call, const char* input, const mimetra_data* data);
  /* Sets or adds a value from a file, which is read when the call runs, with the call's parameters
   * ("frames", "weights"). Values from files come after given values. */
  mimetra_status (*call_read)(mimetra_call* call, const char* input, const char* text);
  /* Asks for an optional output; needed outputs are always made. */
  mimetra_status (*call_want)(mimetra_call* call, const char* output);
  /* Asks for an output and for its files. call_run writes them as the command does, in the format
   * of the path's extension and with the call's parameters of writing. It adds the run's manifest
   * beside or in them. If `output` is NULL, it writes only the manifest, as JSON: version, the
   * value of every parameter, the inputs with hashes of their files, and the report. "align" can
   * restore the motion from such a manifest. Existing files are an error unless `replace` is set,
   * which replaces the result of an earlier run. */
  mimetra_status (*call_write)(mimetra_call* call, const char* output, const char* path,
                               int32_t replace);
  /* Runs the call. It may run again after changes. */
  mimetra_status (*call_run)(mimetra_call* call);
  /* Number of values of an output; 0 before a run, and if the output was not asked for. */
  int32_t (*call_output_count)(const mimetra_call* call, const char* output);
  /* One value of an output. It outlives the call; free it with free_data. */
  mimetra_status (*call_output)(mimetra_call* call, const char* output, int32_t index,
                                mimetra_data** data);
  /* Output of the command with --json, and without. Valid until the next run; initially "". */
  const char* (*call_report)(const mimetra_call* call);
  const char* (*call_summary)(const mimetra_call* call);

  /* -- For third-party operations: functions for a run. Their results belong to the job -- */

  /* A context for making values and calling the toolkit's own operations. If run returns an error,
   * its message is the last error of this context. Call job_fail if run fails for another reason,
   * or if it has handled that error. */
  mimetra_context* (*job_context)(mimetra_job* job);
  /* Value `index` of an input; NULL past the last value, and for an optional input without one. */
  const mimetra_data* (*job_input)(mimetra_job* job, const char* input, int32_t index);
  /* A parameter as a number: flags are 0 or 1, lengths in the unit of the first input with
   * positions. NaN if it has no value or is not a number. */
  double (*job_number)(mimetra_job* job, const char* parameter);
  /* A parameter of any kind as text; NULL if it has no value. */
  const char* (*job_text)(mimetra_job* job, const char* parameter);
  /* Maximum number of threads; 0 for all there are. */
  int32_t (*job_threads)(mimetra_job* job);
  /* 1 if an optional output was asked for, and always for needed outputs. */
  int32_t (*job_wants)(mimetra_job* job, const char* output);
  /* Reports progress, clamped to [0, 1]. Call it often. If it returns MIMETRA_CANCELLED, free what
   * you hold and return that. */
  mimetra_status (*job_progress)(mimetra_job* job, double share);
  void (*job_log)(mimetra_job* job, int32_t level, const char* text);
  /* Sets the reason why run fails, and returns `status` for run to return. */
  mimetra_status (*job_fail)(mimetra_job* job, mimetra_status status, const char* message);
  /* Adds a value to an output, once for each value of a repeated one. You still own `data`. */
  mimetra_status (*job_output)(mimetra_job* job, const char* output, const mimetra_data* data);
  /* Sets the result for programs, a JSON object, and for users, lines of text. */
  mimetra_status (*job_report)(mimetra_job* job, const char* json, const char* summary);

  /* -- Formats -- */

  /* All formats of files, the toolkit's and those of plugins; a list that ends with NULL. */
  const mimetra_format* const* (*formats)(const mimetra_context* context);
} mimetra_interface;

/* True if the library that serves `m` is new enough to have a function. */
#define MIMETRA_HAS(m, function) \
  ((m)->struct_size >= offsetof(mimetra_interface, function) + sizeof((m)->function))

typedef const mimetra_interface* (*mimetra_get_interface_function)(uint32_t version);

/* Table of a version, or NULL if this library does not serve it. The library's only symbol. */
MIMETRA_EXPORT const mimetra_interface* mimetra_get_interface(uint32_t version);

/* ---- Third-party operations and formats ----------------------------------------------------- */

/*
 * A plugin is a shared library with one function, which describes its operations and formats:
 *
 *   MIMETRA_EXPORT const mimetra_plugin* mimetra_get_plugin(void) { return &plugin; }
 *
 * It links nothing of mimetra: run() gets the table of functions in the version that the plugin was
 * compiled with. mimetra calls mimetra_get_plugin() for each context, one call at a time. The
 * description must not change until the process ends. run() may be called from several threads at
 * once, each with its own job.
 *
 * Plugins are the files *.so in the folders of MIMETRA_PLUGIN_PATH (separated by ':') and in
 * lib/mimetra/plugins of the installation. Their operations appear in the command, with help and
 * completion, and in every host. A plugin that cannot be used (another version, no
 * mimetra_get_plugin, a name that is taken, a description with errors) is reported and skipped. The
 * results of a run are checked. An error, an exception or an impossible value ends only that run,
 * with a message.
 */
typedef struct mimetra_plugin {
  uint32_t struct_size;
  uint32_t version; /* MIMETRA_INTERFACE_VERSION */
  const char* name; /* for messages */
  const mimetra_operation* const* operations;
  const mimetra_format* const* formats; /* NULL for none */
} mimetra_plugin;

typedef const mimetra_plugin* (*mimetra_get_plugin_function)(void);

/* Defined by the plugin. */
MIMETRA_EXPORT const mimetra_plugin* mimetra_get_plugin(void);

#ifdef __cplusplus
}
#endif

#endif
