#include "fuzz_viewers.h"

#include "linespace/files/mesh_io.h"
#include "tests/support/unhurried.h"
#include "viewers/builtin_scene.h"
#include "viewers/queries/shadow_questions.h"
#include "viewers/queries/viewpoint_answer.h"
#include "viewers/questions.h"
#include "viewers/skeleton_file.h"

namespace sightline::fuzz {
namespace {

using viewers::JsonInput;

template <class Read>
void refusing(const Read& read) {
  try {
    read();
  } catch (const InvalidInput&) {
  }
}

const Scene& room() {
  static const Scene scene(
      internal::read_obj("room.obj", viewers::builtin_scene(), test::Unhurried()));
  return scene;
}

}  // namespace

void run_portals(const std::string& bytes) {
  refusing([&] { (void)viewers::portals_question(JsonInput("fuzz", bytes)); });
}

void run_transversals(const std::string& bytes) {
  refusing([&] { (void)viewers::transversals_question(JsonInput("fuzz", bytes)); });
}

void run_visible(const std::string& bytes) {
  VisibilityRequest request;  // checks the question, and tries one segment
  request.samples = 1;
  request.samples_only = true;
  refusing([&] {
    for (const auto& question : viewers::visibility_questions(JsonInput("fuzz", bytes))) {
      refusing([&] { (void)polygon_visibility(question, request); });
    }
  });
}

void run_look(const std::string& bytes) {
  refusing([&] { (void)viewers::view_questions(JsonInput("fuzz", bytes)); });
}

void run_path(const std::string& bytes) {
  refusing([&] { (void)viewers::path_question(JsonInput("fuzz", bytes)); });
}

void run_points(const std::string& bytes) {
  const std::string name = bytes.starts_with('{') ? "fuzz.json" : "fuzz.txt";
  refusing([&] { (void)viewers::shadow_questions(room(), name, bytes); });
}

void run_aspects(const std::string& bytes) {
  refusing([&] {
    (void)viewers::saved_aspects(JsonInput("fuzz", bytes), Projection::Perspective);
  });
}

void run_skeleton(const std::string& bytes) {
  static const std::string fingerprint = viewers::fingerprint(room());
  refusing([&] {
    viewers::StoredSkeleton stored = viewers::parse_skeleton_json("fuzz", bytes);
    stored.fingerprint = fingerprint;
    viewers::check_fits(stored, room());
  });
}

}  // namespace sightline::fuzz
