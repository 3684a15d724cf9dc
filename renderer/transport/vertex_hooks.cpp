#include "transport/vertex_hooks.h"

namespace lucerna::transport {

gpu::Defines hook_defines(const std::vector<VertexHook>& hooks) {
  if (hooks.empty()) return {};
  std::string text = "#define LUCERNA_VERTEX_HOOKS 1\n#include \"transport/vertex_hook.glsl\"\n";
  for (const VertexHook& hook : hooks) text += "#include \"" + hook.file + "\"\n";
  text += "struct VertexHooks {\n";
  for (const VertexHook& hook : hooks) text += "  " + hook.prefix + "_Vertex " + hook.prefix + ";\n";
  text += "};\n";
  // One function that calls the like of each hook, in order.
  const auto chain = [&](const std::string& head, const std::string& before, const std::string& call,
                         const std::string& after) {
    text += head + " {\n" + before;
    for (const VertexHook& hook : hooks) {
      std::string line = "  " + call + "\n";
      for (size_t at = 0; (at = line.find('$', at)) != std::string::npos;) line.replace(at, 1, hook.prefix);
      text += line;
    }
    text += after + "}\n";
  };
  chain("VertexHooks hooks_read(VertexIn v, inout VertexOut o)", "  VertexHooks h;\n", "h.$ = $_read(v, o);",
        "  return h;\n");
  chain("vec3 hooks_cosine(VertexIn v, inout VertexHooks h, vec2 u, vec3 cosine)", "",
        "cosine = $_cosine(v, h.$, u, cosine);", "  return cosine;\n");
  chain("void hooks_weigh(VertexIn v, VertexHooks h, vec3 direction, inout BsdfSample b)", "",
        "$_weigh(v, h.$, direction, b);", "");
  chain("uint hooks_state(VertexIn v, VertexHooks h, BsdfSample b, uint state)", "",
        "state = $_state(v, h.$, b, state);", "  return state;\n");
  chain(
      "void hooks_leave(VertexIn v, inout VertexHooks h, Leaving l, inout vec3 throughput, inout bool go_on)",
      "", "$_leave(v, h.$, l, throughput, go_on);", "");
  chain("void hooks_end(VertexIn v, VertexHooks h)", "", "$_end(v, h.$);", "");
  return {{gpu::k_include_define + std::string("transport/vertex_hooks.glsl"), text}};
}

}  // namespace lucerna::transport
