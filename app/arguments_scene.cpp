// lucerna info, convert, devices: what a scene or this machine has.
#include "app/arguments.h"
#include "app/verbs.h"

namespace lucerna::app {
namespace {

Verb add_info(CLI::App& app, Common& common) {
  const auto arguments = std::make_shared<InfoArguments>();
  InfoArguments& a = *arguments;
  CLI::App* verb =
      app.add_subcommand("info", "describe a scene: contents, and effects that it calls for, with evidence");
  verb->add_option("SCENE", a.scene, "glTF scene")->required();
  verb->add_flag("--json", a.json, "as JSON");
  verb->add_flag("--pilot", a.pilot,
                 "trace a few samples: light, noise and the solver that components.X=auto chooses for each "
                 "component, with its reason, and a forecast");
  verb->add_flag("--cost", a.cost,
                 "trace small pictures without each of the effects: what it costs per sample, the light and "
                 "the noise that are in it, and how much of it is seen; about a minute");
  verb->add_option("--size", a.size, "--pilot, --cost: size of the picture, WIDTHxHEIGHT")
      ->capture_default_str();
  verb->add_option("--camera", a.camera,
                   "--pilot, --cost: name of a camera of the scene, or its number from 1");
  verb->add_option("--set", a.set, "--pilot, --cost: KEY=VALUE")->allow_extra_args(false);
  verb->add_option("--device", a.device, k_device_help);
  add_scene_options(*verb, common);
  const auto run = runs(info, arguments, common);
  return {verb, run};
}

Verb add_convert(CLI::App& app, Common& common) {
  const auto arguments = std::make_shared<ConvertArguments>();
  ConvertArguments& a = *arguments;
  CLI::App* verb = app.add_subcommand(
      "convert", "write a scene as another .gltf or .glb file; what Lucerna does not know is kept");
  verb->add_option("SCENE", a.scene, "glTF scene")->required();
  verb->add_option("OUTPUT", a.output, "file to write: .gltf or .glb")->required()->check(named());
  verb->add_flag("--replace", a.replace, "write over the scene itself");
  add_scene_options(*verb, common);
  const auto run = runs(convert, arguments, common);
  return {verb, run};
}

Verb add_devices(CLI::App& app) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* verb = app.add_subcommand("devices", "list the Vulkan devices");
  verb->add_flag("--json", *json, "as JSON");
  return {verb, [json] { return devices(*json); }};
}

}  // namespace

std::vector<Verb> add_scene_verbs(CLI::App& app, Common& common) {
  return {add_info(app, common), add_convert(app, common), add_devices(app)};
}

}  // namespace lucerna::app
