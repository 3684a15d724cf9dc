// Commands that define layers by path expressions, one by one (film.layers has them all).
#include <algorithm>

#include "base/error.h"
#include "base/log.h"
#include "commands/command_list.h"
#include "commands/text.h"
#include "commands/workspace.h"
#include "session/layer_status.h"

namespace lucerna::commands {

void add_layer_commands(Workspace& work) {
  const auto layers = [&work] { return session::layers_in(work.open.setting("film.layers")); };
  const auto names = [layers] {
    std::vector<std::string> list;
    for (const paths::Layer& layer : layers()) list.push_back(layer.name);
    return list;
  };
  work.registry.add(
      {.name = "layer.add",
       .help = "Adds a layer of the light of certain paths (film.layers), or gives one another expression. "
               "The picture "
               "starts again; film.layer shows a layer.",
       .parameters = {{.name = "name", .help = "letters, digits, '_' and '-'"},
                      {.name = "expression",
                       .help = "of words from E, the eye, over D, G and S, diffuse, glossy and specular "
                               "events, to L, the light: E[SG]+D.*L"}},
       .run =
           [&work, layers](const Arguments& a) {
             work.open.needs_scene();
             std::vector<paths::Layer> all = layers();
             const auto at = std::find_if(all.begin(), all.end(), [&](const paths::Layer& layer) {
               return layer.name == a.text("name");
             });
             if (at != all.end() && at->expression != a.text("expression"))
               log::info("layer '{}' is now {}; it was {}", at->name, a.text("expression"), at->expression);
             if (at != all.end())
               at->expression = a.text("expression");
             else
               all.push_back({a.text("name"), a.text("expression")});
             session::check_layers(paths::layers_text(all));
             work.run(line("set", "film.layers", paths::layers_text(all)));
           },
       .recorded = false});
  work.registry.add({.name = "layer.remove",
                     .help = "Removes a layer that layer.add has made. The picture starts again.",
                     .parameters = {{.name = "name",
                                     .names = [names](const std::vector<std::string>&) { return names(); }}},
                     .run =
                         [&work, layers, names](const Arguments& a) {
                           std::vector<paths::Layer> all = layers();
                           const size_t before = all.size();
                           std::erase_if(
                               all, [&](const paths::Layer& layer) { return layer.name == a.text("name"); });
                           if (before == 0) throw Error("", "no layer has been added");
                           if (all.size() == before)
                             throw Error("", fmt::format("there is no layer '{}'; there are {}",
                                                         a.text("name"), fmt::join(names(), ", ")));
                           if (work.open.setting("film.layer") == a.text("name"))
                             work.run("set film.layer beauty");
                           work.run(line("set", "film.layers", paths::layers_text(all)));
                         },
                     .recorded = false});
}

}  // namespace lucerna::commands
