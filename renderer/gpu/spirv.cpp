#include "gpu/spirv.h"

#include <algorithm>
#include <glslang/SPIRV/spirv.hpp>
#include <map>
#include <set>

#include "base/error.h"

namespace lucerna::gpu::spirv {

namespace {

constexpr size_t k_header_words = 5;

struct Instruction {
  uint32_t op;
  uint32_t count;
  const uint32_t* words;  ///< words[0] is the opcode and the count
};

/// Calls visit(instruction) for every instruction.
template <class Visit>
void for_each(const std::vector<uint32_t>& words, Visit&& visit) {
  for (size_t at = k_header_words; at < words.size();) {
    const uint32_t count = words[at] >> 16;
    if (count == 0 || at + count > words.size()) throw Error("shader", "damaged SPIR-V");
    visit(Instruction{words[at] & 0xffffu, count, &words[at]});
    at += count;
  }
}

std::string literal(const Instruction& i, uint32_t first) {
  std::string text;
  for (uint32_t w = first; w < i.count; ++w)
    for (int byte = 0; byte < 4; ++byte) {
      const char c = static_cast<char>(i.words[w] >> (8 * byte));
      if (!c) return text;
      text += c;
    }
  return text;
}

struct Variable {
  uint32_t id, pointer_type, storage;
};

struct Type {
  uint32_t op = 0;
  std::vector<uint32_t> operands;  ///< after the result id
};

struct Parsed {
  std::map<uint32_t, std::string> names;
  std::map<uint32_t, std::vector<std::string>> member_names;
  std::map<uint32_t, std::map<uint32_t, uint32_t>> member_offsets, member_strides;
  std::map<uint32_t, uint32_t> bindings, array_strides, spec_ids, constants;
  std::map<uint32_t, std::vector<uint32_t>> composites;
  std::set<uint32_t> blocks, buffer_blocks;
  std::map<uint32_t, Type> types;
  std::vector<Variable> variables;
  uint32_t entry = 0, workgroup_id = 0;
  uint32_t local_size[3] = {1, 1, 1};

  explicit Parsed(const std::vector<uint32_t>& words) {
    for_each(words, [&](const Instruction& i) { read(i); });
  }

  void read(const Instruction& i) {
    const uint32_t* w = i.words;
    switch (i.op) {
      case spv::OpName:
        names[w[1]] = literal(i, 2);
        break;
      case spv::OpMemberName: {
        auto& list = member_names[w[1]];
        if (list.size() <= w[2]) list.resize(w[2] + 1);
        list[w[2]] = literal(i, 3);
        break;
      }
      case spv::OpEntryPoint:
        entry = w[2];
        break;
      case spv::OpExecutionMode:
        if (w[2] == spv::ExecutionModeLocalSize) std::copy(w + 3, w + 6, local_size);
        break;
      case spv::OpDecorate:
        if (w[2] == spv::DecorationBinding) bindings[w[1]] = w[3];
        if (w[2] == spv::DecorationBlock) blocks.insert(w[1]);
        if (w[2] == spv::DecorationBufferBlock) buffer_blocks.insert(w[1]);
        if (w[2] == spv::DecorationArrayStride) array_strides[w[1]] = w[3];
        if (w[2] == spv::DecorationSpecId) spec_ids[w[1]] = w[3];
        if (w[2] == spv::DecorationBuiltIn && w[3] == spv::BuiltInWorkgroupSize) workgroup_id = w[1];
        break;
      case spv::OpMemberDecorate:
        if (w[3] == spv::DecorationOffset) member_offsets[w[1]][w[2]] = w[4];
        if (w[3] == spv::DecorationMatrixStride) member_strides[w[1]][w[2]] = w[4];
        break;
      case spv::OpConstant:
      case spv::OpSpecConstant:
        constants[w[2]] = w[3];
        break;
      case spv::OpConstantComposite:
      case spv::OpSpecConstantComposite:
        composites[w[2]].assign(w + 3, w + i.count);
        break;
      case spv::OpVariable:
        variables.push_back({w[2], w[1], w[3]});
        break;
      default:
        if (i.op >= spv::OpTypeVoid && i.op <= spv::OpTypeFunction)
          types[w[1]] = {i.op, std::vector<uint32_t>(w + 2, w + i.count)};
    }
  }

  uint32_t pointee(uint32_t pointer_type) const { return types.at(pointer_type).operands[1]; }

  /// True if the variable is a buffer, of words or of texels.
  bool is_buffer(const Variable& v) const {
    const Type* type = &types.at(pointee(v.pointer_type));
    if (type->op == spv::OpTypeSampledImage) type = &types.at(type->operands[0]);
    return type->op == spv::OpTypeStruct ||
           (type->op == spv::OpTypeImage && type->operands[1] == spv::DimBuffer);
  }

  /// Bytes from the start to the end of the last member; for push constants.
  uint32_t size_of(uint32_t id, uint32_t matrix_stride = 0) const {
    const Type& type = types.at(id);
    switch (type.op) {
      case spv::OpTypeInt:
      case spv::OpTypeFloat:
        return type.operands[0] / 8;
      case spv::OpTypeVector:
        return type.operands[1] * size_of(type.operands[0]);
      case spv::OpTypeMatrix:
        return (type.operands[1] - 1) * matrix_stride + size_of(type.operands[0]);
      case spv::OpTypeArray:
        return constants.at(type.operands[1]) * array_strides.at(id);
      case spv::OpTypeStruct: {
        uint32_t bytes = 0;
        for (uint32_t m = 0; m < type.operands.size(); ++m) {
          const auto strides = member_strides.find(id);
          const uint32_t stride =
              strides != member_strides.end() && strides->second.count(m) ? strides->second.at(m) : 0;
          bytes = std::max(bytes, member_offsets.at(id).at(m) + size_of(type.operands[m], stride));
        }
        return bytes;
      }
      default:
        throw Error("shader", "a push constant of a kind that is not supported");
    }
  }
};

bool is_resource(uint32_t storage) {
  return storage == spv::StorageClassUniformConstant || storage == spv::StorageClassUniform ||
         storage == spv::StorageClassStorageBuffer || storage == spv::StorageClassPushConstant;
}

/// Variables that functions reachable from the entry point read or write.
std::set<uint32_t> used_variables(const std::vector<uint32_t>& words, const Parsed& parsed) {
  std::set<uint32_t> globals;
  for (const Variable& v : parsed.variables)
    if (v.storage != spv::StorageClassFunction) globals.insert(v.id);
  std::map<uint32_t, std::set<uint32_t>> uses, calls;
  uint32_t function = 0;
  for_each(words, [&](const Instruction& i) {
    if (i.op == spv::OpFunction) function = i.words[2];
    if (i.op == spv::OpFunctionEnd) function = 0;
    if (!function) return;
    const auto use = [&](uint32_t word) {
      if (word < i.count && globals.count(i.words[word])) uses[function].insert(i.words[word]);
    };
    switch (i.op) {
      case spv::OpFunctionCall:
        calls[function].insert(i.words[3]);
        for (uint32_t w = 4; w < i.count; ++w) use(w);
        break;
      case spv::OpStore:
      case spv::OpAtomicStore:
        use(1);
        break;
      case spv::OpCopyMemory:
        use(1), use(2);
        break;
      case spv::OpLoad:
      case spv::OpAccessChain:
      case spv::OpInBoundsAccessChain:
      case spv::OpPtrAccessChain:
      case spv::OpCopyObject:
      case spv::OpArrayLength:
      case spv::OpImageTexelPointer:
        use(3);
        break;
      default:
        if (i.op >= spv::OpAtomicLoad && i.op <= spv::OpAtomicXor) use(3);
    }
  });
  std::set<uint32_t> reached, used;
  std::vector<uint32_t> open{parsed.entry};
  while (!open.empty()) {
    const uint32_t f = open.back();
    open.pop_back();
    if (!reached.insert(f).second) continue;
    used.insert(uses[f].begin(), uses[f].end());
    open.insert(open.end(), calls[f].begin(), calls[f].end());
  }
  return used;
}

}  // namespace

std::vector<uint32_t> trim(const std::vector<uint32_t>& words) {
  if (words.size() <= k_header_words) throw Error("shader", "damaged SPIR-V");
  const Parsed parsed(words);
  const std::set<uint32_t> used = used_variables(words, parsed);
  std::set<uint32_t> resources, dropped;
  std::map<uint32_t, uint32_t> binding;
  std::map<uint32_t, Variable> variables;
  for (const Variable& v : parsed.variables) {
    if (!is_resource(v.storage)) continue;
    resources.insert(v.id);
    variables[v.id] = v;
    if (!used.count(v.id)) {
      dropped.insert(v.id);
    } else if (v.storage != spv::StorageClassPushConstant) {
      const auto number = static_cast<uint32_t>(binding.size());
      binding[v.id] = number;
    }
  }
  std::vector<uint32_t> out(words.begin(), words.begin() + k_header_words);
  bool decorated = false;
  for_each(words, [&](const Instruction& i) {
    const uint32_t* w = i.words;
    if ((i.op == spv::OpName || i.op == spv::OpDecorate) && dropped.count(w[1])) return;
    if (i.op == spv::OpVariable && dropped.count(w[2])) return;
    if (i.op == spv::OpDecorate && resources.count(w[1]) &&
        (w[2] == spv::DecorationBinding || w[2] == spv::DecorationDescriptorSet))
      return;
    // Annotations come just before types; ours go at their end.
    const bool annotation = i.op == spv::OpDecorate || i.op == spv::OpMemberDecorate;
    const bool preamble =
        annotation || i.op == spv::OpName || i.op == spv::OpMemberName || i.op == spv::OpString ||
        i.op == spv::OpSource || i.op == spv::OpSourceExtension || i.op == spv::OpSourceContinued ||
        i.op == spv::OpCapability || i.op == spv::OpExtension || i.op == spv::OpExtInstImport ||
        i.op == spv::OpMemoryModel || i.op == spv::OpEntryPoint || i.op == spv::OpExecutionMode ||
        i.op == spv::OpExecutionModeId || i.op == spv::OpModuleProcessed;
    if (!preamble && !decorated) {
      decorated = true;
      for (const auto& [id, number] : binding) {
        const uint32_t aliased[] = {3u << 16 | spv::OpDecorate, id, spv::DecorationAliased};
        const uint32_t set[] = {4u << 16 | spv::OpDecorate, id, spv::DecorationDescriptorSet, 0};
        const uint32_t slot[] = {4u << 16 | spv::OpDecorate, id, spv::DecorationBinding, number};
        out.insert(out.end(), set, set + 4);
        out.insert(out.end(), slot, slot + 4);
        if (parsed.is_buffer(variables.at(id))) out.insert(out.end(), aliased, aliased + 3);
      }
    }
    if (i.op == spv::OpEntryPoint) {
      const size_t start = out.size();
      const uint32_t interface = 3 + static_cast<uint32_t>(literal(i, 3).size() / 4 + 1);
      out.insert(out.end(), w, w + interface);
      for (uint32_t k = interface; k < i.count; ++k)
        if (!dropped.count(w[k])) out.push_back(w[k]);
      out[start] = static_cast<uint32_t>(out.size() - start) << 16 | spv::OpEntryPoint;
      return;
    }
    out.insert(out.end(), w, w + i.count);
  });
  return out;
}

Module reflect(const std::vector<uint32_t>& words) {
  const Parsed parsed(words);
  Module module;
  for (const Variable& v : parsed.variables) {
    if (!is_resource(v.storage)) continue;
    const uint32_t type_id = parsed.pointee(v.pointer_type);
    if (v.storage == spv::StorageClassPushConstant) {
      module.push_constant_bytes = parsed.size_of(type_id);
      continue;
    }
    Resource resource;
    resource.binding = parsed.bindings.at(v.id);
    const Type& type = parsed.types.at(type_id);
    uint32_t named = v.id;
    if (type.op == spv::OpTypeStruct) {
      named = type_id;
      const bool storage = v.storage == spv::StorageClassStorageBuffer || parsed.buffer_blocks.count(type_id);
      resource.kind = storage ? ResourceKind::storage_buffer : ResourceKind::uniform_buffer;
    } else if (type.op == spv::OpTypeSampledImage || type.op == spv::OpTypeImage) {
      const Type& image = type.op == spv::OpTypeImage ? type : parsed.types.at(type.operands[0]);
      const uint32_t dimension = image.operands[1], arrayed = image.operands[3], sampled = image.operands[5];
      const Type& component = parsed.types.at(image.operands[0]);
      const bool floats = component.op == spv::OpTypeFloat;
      const bool words = component.op == spv::OpTypeInt && component.operands[1] == 0;
      if (dimension == spv::DimBuffer && sampled == 1 && floats) resource.kind = ResourceKind::texel_buffer;
      if (dimension == spv::DimBuffer && sampled == 1 && words)
        resource.kind = ResourceKind::texel_buffer_words;
      if (dimension == spv::DimBuffer && sampled == 2 && floats) resource.kind = ResourceKind::texel_image;
      if (dimension == spv::Dim2D && arrayed && type.op == spv::OpTypeSampledImage)
        resource.kind = ResourceKind::sampled_image;
    }
    if (const auto name = parsed.names.find(named); name != parsed.names.end()) resource.name = name->second;
    module.resources.push_back(std::move(resource));
  }
  std::sort(module.resources.begin(), module.resources.end(),
            [](const Resource& a, const Resource& b) { return a.binding < b.binding; });
  std::copy(parsed.local_size, parsed.local_size + 3, module.workgroup);
  if (const auto size = parsed.composites.find(parsed.workgroup_id); size != parsed.composites.end())
    for (int axis = 0; axis < 3; ++axis) {
      const uint32_t id = size->second[axis];
      module.workgroup[axis] = parsed.constants.at(id);
      if (const auto spec = parsed.spec_ids.find(id); spec != parsed.spec_ids.end())
        module.workgroup_constant[axis] = static_cast<int32_t>(spec->second);
    }
  return module;
}

std::vector<Member> struct_members(const std::vector<uint32_t>& words, const std::string& name) {
  const Parsed parsed(words);
  std::vector<Member> members;
  for (const auto& [id, type] : parsed.types) {
    if (type.op != spv::OpTypeStruct) continue;
    const auto found = parsed.names.find(id);
    const auto offsets = parsed.member_offsets.find(id);
    if (found == parsed.names.end() || found->second != name || offsets == parsed.member_offsets.end())
      continue;
    for (const auto& [index, offset] : offsets->second)
      members.push_back({parsed.member_names.at(id).at(index), offset});
    break;
  }
  return members;
}

uint32_t struct_stride(const std::vector<uint32_t>& words, const std::string& name) {
  const Parsed parsed(words);
  for (const auto& [id, type] : parsed.types) {
    if (type.op != spv::OpTypeRuntimeArray && type.op != spv::OpTypeArray) continue;
    const uint32_t element = type.operands[0];
    const auto found = parsed.names.find(element);
    const auto stride = parsed.array_strides.find(id);
    if (found != parsed.names.end() && found->second == name && stride != parsed.array_strides.end())
      return stride->second;
  }
  return 0;
}

}  // namespace lucerna::gpu::spirv
