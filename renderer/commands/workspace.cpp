#include "commands/workspace.h"

#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "commands/command_list.h"

namespace lucerna::commands {

Workspace::Workspace(session::Session& s, WorkspaceEvents e)
    : session(s),
      open(s),
      camera(s),
      history(open, camera),
      exposure(open, camera),
      scene_file(open, history),
      events(std::move(e)) {
  add_setting_commands(*this);
  add_light_commands(*this);
  add_object_commands(*this);
  add_sun_commands(registry, open);
  add_environment_commands(registry, open);
  add_environment_file_commands(registry, open);
  add_material_commands(registry, open);
  add_shown_commands(registry, open);
  add_history_commands(*this);
  add_camera_commands(registry, open, camera);
  add_selection_commands(*this);
  add_lens_commands(registry, open, camera);
  add_walking_commands(registry, camera);
  add_bookmark_commands(*this);
  add_exposure_commands(registry, open, camera, exposure);
  add_mix_commands(registry, open);
  add_scene_commands(*this);
  add_save_commands(*this);
  add_render_commands(*this);
  add_script_commands(*this);
  add_session_test_commands(*this);
  add_wait_commands(*this);
  add_inspect_commands(*this);
  add_effect_commands(registry, open);
  add_path_commands(*this);
  add_region_commands(*this);
  add_viewer_commands(*this);
  add_layer_commands(*this);
  add_ocio_commands(*this);
  add_compare_commands(*this);
  add_solver_commands(registry, open, files);
  add_values(*this);
}

void Workspace::note_log(log::Level level, const std::string& text) {
  constexpr size_t k_kept = 1000;
  if (level == log::Level::error) ++error_count;
  if (level != log::Level::error && level != log::Level::warning) return;
  problems.push_back({text, level == log::Level::error ? error_count : 0, false, script_line});
  if (problems.size() > k_kept) problems.pop_front();
}

void Workspace::refresh(double time) {
  now = time;
  history.refuse(open.refresh());
  follow_scene();
  if (open.id() == camera.view_scene) camera.follow_objects(open.scene);
  if (open.up_to_date() && !open.snapshot->rgba.empty() && open.snapshot->scene_id == camera.view_scene &&
      camera.follow(*open.snapshot) && events.size_refused)
    events.size_refused(open.snapshot->width, open.snapshot->height);
  open.follow_load(camera.view_scene == open.id());
  exposure.follow(interactive(), [&](const Exposure::Found& found) { expose(found); });
  scene_file.follow();
  if (pixel) pixel->follow(open, camera);
  if (traced) traced->refresh();
  if (noise) noise->refresh();
  compare.refresh(open);
  for (const std::string& name : files.take_written())
    if (events.written) events.written(name);
}

bool Workspace::interactive() const { return events.exposes_at_load && events.exposes_at_load(); }

void Workspace::expose(const Exposure::Found& found) {
  const bool clean = !scene_file.unsaved(), of_load = found.reason == Exposure::Reason::load;
  run(line("set", "film.ev", found.ev));
  if (of_load && clean) scene_file.note_clean();
  if (found.reason == Exposure::Reason::daylight) history.join_latest(found.step);
  if (!events.measured) return;
  events.measured(of_load ? fmt::format("The scene names no exposure; {:+.1f} EV was found for it", found.ev)
                          : fmt::format("Exposure {:+.2f} EV", found.ev));
}

void Workspace::follow_scene() {
  const session::Snapshot* picture = open.snapshot.get();
  if (!picture || !open.scene || picture->scene_id == camera.view_scene || picture->rgba.empty()) return;
  if (picture->scene_id != open.id()) return;  // the next one is there already, without a picture
  camera.begin_scene(open.scene, *picture);
  open.begin_scene();
  history.forget_steps();
  scene_file.begin_scene();
  exposure.begin_scene();
  traced.reset(), noise.reset(), compare.holding.reset();
  if (open.loading()) history.record({"wait_scene", "wait_scene"});
  if (events.scene_changed) events.scene_changed();
}

Line Workspace::run(const std::string& text, uint64_t gesture, const std::string& where) {
  const Line line = registry.parse(text, where);
  if (!line.command) return line;
  const uint64_t before = session.commands();
  carry_out(line, gesture, where);
  history.note_sent(before, text, line.command->moves);
  return line;
}

namespace {

/// Runs the command; errors are located and begin with its name.
void run_located(const Line& line, const std::string& where) {
  try {
    line.command->run(line.arguments);
  } catch (const std::exception& error) {
    const std::string what = error.what();
    const std::string head = line.command->name + ": ";
    throw Error(where, what.starts_with(head) ? what : head + what);
  }
}

}  // namespace

void Workspace::carry_out(const Line& line, uint64_t gesture, const std::string& where) {
  if (line.command->undoable) return execute_edit(line, gesture, where);
  const History::Mark before = history.mark();
  const std::optional<Viewpoint> view_before = camera.view;
  const int camera_before = camera.scene_camera;
  run_located(line, where);
  const History::Executed executed{registry.print(line), registry.target(line), gesture,
                                   history.sent_since(before)};
  if (line.command->moves && view_before && camera.view)
    history.add_move(executed, *view_before, camera_before);
  record(line, executed);
}

namespace {

/// True if the environment is another one, not only changed.
bool other_environment(const Document& a, const Document& b) {
  return a.environment_file != b.environment_file || a.sky.has_value() != b.sky.has_value() ||
         (a.sky && a.sky->kind != b.sky->kind);
}

}  // namespace

void Workspace::execute_edit(const Line& line, uint64_t gesture, const std::string& where) {
  const History::Mark before = history.mark();
  const std::string target = registry.target(line);
  const Document* merged = history.merged(gesture, target);
  const Document now_seen = open.document();
  // A step of a drag starts from where the drag began, so that the last step alone gives the same.
  open.begin_edit(merged ? *merged : now_seen);
  try {
    run_located(line, where);
  } catch (...) {
    open.cancel_edit();
    throw;
  }
  const Document after = open.end_edit();
  camera.follow_lights(now_seen.lights, after.lights);
  open.send(now_seen, after);
  const bool requested = open.loading() && open.named_settings();
  History::Executed executed{registry.print(line), target, gesture, history.sent_since(before)};
  // A step of a material's drag may have taken the number of the one before.
  if (executed.sent.last < executed.sent.first && now_seen.materials != after.materials)
    executed.sent.first = executed.sent.last;
  if (merged || after != now_seen)
    history.add_edit(executed, now_seen, after, merged != nullptr);
  else if (!requested)
    return;
  history.forget_redo();
  record(line, executed);
  const bool sun = line.command->replaces_sunlight && line.command->replaces_sunlight(line.arguments);
  if (sun || other_environment(now_seen, after))
    exposure.daylight_replaced(interactive(), history.position());
}

void Workspace::record(const Line& line, History::Executed executed) {
  if (!line.command->recorded) return;
  executed.line = line.command->name;
  // Files are named so that the script works from any folder.
  for (const Parameter& p : line.command->parameters) {
    if (!line.arguments.has(p.name)) continue;
    std::string value = line.arguments.text(p.name);
    if (p.names_file(value)) value = absolute_path(value).string();
    executed.line += " " + (p.optional ? p.name + "=" : "") + quote(value);
  }
  const bool writes = std::any_of(line.command->parameters.begin(), line.command->parameters.end(),
                                  [](const Parameter& p) { return p.writes; });
  history.record(std::move(executed), writes ? files.latest() : session::Saved());
}

}  // namespace lucerna::commands
