#include <sys/stat.h>

#include "tests/cli/bad_input.h"

/// What somebody else made so that it does harm, or never ends.
namespace mimetra::test {

namespace {

std::function<void(const fs::path&)> pipe_named(const std::string& name) {
  return [name](const fs::path& folder) { mkfifo((folder / name).c_str(), 0600); };
}

std::string list_of(const std::string& file) {
  return "<VTKFile><Collection><DataSet timestep=\"0\" file=\"" + file +
         "\"/></Collection></VTKFile>";
}

std::string repeated(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

}  // namespace

std::vector<BadInput> hostile_cases() {
  std::vector<BadInput> all;
  for (const std::string name : {"p.obj", "p.npy", "p.npz", "p.pc2", "p.pvd", "p.vtp"}) {
    const bool needs_faces = name == "p.npy" || name == "p.pc2";
    add_case(all, "named_pipe", name.substr(2), pipe_named(name),
             "info " + name + (needs_faces ? " --topology head/neutral.ply" : ""), 3,
             {name, "is a named pipe"});
  }
  add_case(all, "named_pipe", "config", pipe_named("c.json"),
           "regions head --weights take.csv --config c.json -o r.json", 3,
           {"c.json", "is a named pipe"});
  add_case(all, "named_pipe", "expression", pipe_named("head/expressions/x.ply"), "info head", 3,
           {"x.ply", "is a named pipe"});
  add_case(all, "device", "pvd", file("d.pvd", list_of("/dev/zero")), "info d.pvd", 3,
           {"/dev/zero: is a device"});
  add_case(all, "loop", "pvd", file("l.pvd", list_of("l.pvd")), "info l.pvd", 3, {"PolyData"});
  add_case(all, "nested", "pvd", file("n.pvd", repeated("<a>", 100000)), "info n.pvd", 3,
           {"n.pvd", "more than 32 elements"});
  add_case(all, "nested", "config", file("n.json", repeated("[", 100000)),
           "regions head --weights take.csv --config n.json -o r.json", 3,
           {"n.json", "deeper than 100"});
  add_case(all, "key_twice", "config", file("k.json", "{\"k\": 2, \"k\": 3}"),
           "regions head --weights take.csv --config k.json -o r.json", 3,
           {"k.json", "'k' occurs twice"});
  add_case(all, "entities", "pvd", file("e.pvd", "<!DOCTYPE a [<!ENTITY b \"c\">]>" + list_of("a")),
           "info e.pvd", 3, {"e.pvd", "<!ENTITY"});
  add_case(all, "terminal_escape", "name", file("a\x1b[31m.obj", "v 0 0\n"), "info 'a\x1b[31m.obj'",
           3, {"a\\x1b[31m.obj: "});
  add_case(all, "not_utf8", "name", file("br\xe4ue.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
           "convert 'br\xe4ue.obj' -o b.npy --json", 0, {"\"frames\": 1"});
  return all;
}

}  // namespace mimetra::test
