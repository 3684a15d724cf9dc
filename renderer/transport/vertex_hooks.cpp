#include "transport/vertex_hooks.h"

namespace lucerna::transport {

gpu::Defines hook_defines(const std::vector<VertexHook>& hooks) {
  if (hooks.empty()) return {};
  std::string text = "#define LUCERNA_VERTEX_HOOKS 1\n#include \"transport/vertex_hook.glsl\"\n";
  for (const VertexHook& hook : hooks) text += "#include \"" + hook.file + "\"\n";
  text += "struct VertexHooks {\n";
  for (const VertexHook& hook : hooks) text += "  " + hook.prefix + "_Vertex " + hook.prefix + ";\n";
  text += "};\n";
  // One function that calls that of each hook, in order. `macro`: which a hook with this function defines;
  // "": all have it.
  const auto chain = [&](const std::string& head, const std::string& before, const std::string& macro,
                         const std::string& call, const std::string& after) {
    text += head + " {\n" + before;
    for (const VertexHook& hook : hooks) {
      std::string line = "  " + call + "\n";
      if (!macro.empty()) line = "#ifdef $_" + macro + "\n" + line + "#endif\n";
      for (size_t at = 0; (at = line.find('$', at)) != std::string::npos;) line.replace(at, 1, hook.prefix);
      text += line;
    }
    text += after + "}\n";
  };
  chain("VertexHooks hooks_read(VertexIn v, inout VertexOut o)", "  VertexHooks h;\n", "",
        "h.$ = $_read(v, o);", "  return h;\n");
  chain("vec3 hooks_cosine(VertexIn v, inout VertexHooks h, vec2 u, vec3 cosine)", "", "HAS_COSINE",
        "cosine = $_cosine(v, h.$, u, cosine);", "  return cosine;\n");
  chain("void hooks_weigh(VertexIn v, VertexHooks h, vec3 direction, inout BsdfSample b)", "", "HAS_WEIGH",
        "$_weigh(v, h.$, direction, b);", "");
  chain("uint hooks_state(VertexIn v, VertexHooks h, BsdfSample b, uint state)", "", "HAS_STATE",
        "state = $_state(v, h.$, b, state);", "  return state;\n");
  chain(
      "void hooks_leave(VertexIn v, inout VertexHooks h, Leaving l, inout vec3 throughput, inout bool go_on)",
      "", "HAS_LEAVE", "$_leave(v, h.$, l, throughput, go_on);", "");
  chain("void hooks_end(VertexIn v, VertexHooks h)", "", "HAS_END", "$_end(v, h.$);", "");
  return {{gpu::k_include_define + std::string("transport/vertex_hooks.glsl"), text}};
}

}  // namespace lucerna::transport
