// links: gpu
#include <algorithm>

#include "base/math.h"
#include "kernels/gpu_support.h"

namespace gpu_stream_tests {

using namespace lucerna;
using namespace lucerna::gpu;
using Catch::Matchers::Contains;
using test::error_of;
using test::shader;

namespace {

struct ScalePush {
  uint32_t count;
  float factor;
};
struct CountPush {
  uint32_t count, next_groups;
};

/// gpu_scale.comp with its resources.
struct Scale {
  explicit Scale(Device& device, const std::string& offset = "1.5")
      : kernel(device, compiler, shader("gpu_scale.comp"), {{"OFFSET", offset}}),
        source(device, {"source", 4000}),
        target(device, {"target", 4000, Memory::host}) {
    std::vector<float> values(1000);
    for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
    source.write(std::span<const float>(values));
    resources.set("Source", source);
    resources.set("Target", target);
  }
  ShaderCompiler compiler;
  Kernel kernel;
  Buffer source, target;
  Resources resources;
};

/// gpu_count.comp: counts how often each index ran.
struct Count {
  Count(Device& device, uint32_t workgroup, uint32_t size, uint32_t step = 1)
      : kernel(device, compiler, shader("gpu_count.comp"), {}, {{0, workgroup}, {1, step}}),
        marks(device, {"marks", size * 4ull}),
        total(device, {"total", 4}),
        arguments(device, {"arguments", 12}) {
    resources.set("Marks", marks);
    resources.set("Total", total);
    resources.set("Arguments", arguments);
  }
  bool all_marked(uint32_t value) const {
    const auto values = marks.read_all<uint32_t>();
    return std::all_of(values.begin(), values.end(), [&](uint32_t v) { return v == value; });
  }
  ShaderCompiler compiler;
  Kernel kernel;
  Buffer marks, total, arguments;
  Resources resources;
};

}  // namespace

TEST_CASE("a kernel runs with push constants, defines and resources bound by name") {
  test::SilentDevice silent;
  Scale scale(silent.device);
  CHECK(scale.kernel.workgroup_size() == 64);
  CHECK(scale.kernel.push_constant_bytes() == sizeof(ScalePush));
  Stream stream(silent.device);
  stream.dispatch(scale.kernel, scale.resources, ScalePush{1000, 2}, groups_for(1000, 64));
  stream.run();
  const auto result = scale.target.read_all<float>();
  int wrong = 0;
  for (size_t i = 0; i < 1000; ++i) wrong += result[i] != 2 * static_cast<float>(i) + 1.5f;
  CHECK(wrong == 0);
}

TEST_CASE("dispatches, copies and fills of one run see each other's results, and changed resources") {
  test::SilentDevice silent;
  Scale scale(silent.device, "0");
  Buffer other(silent.device, {"other", 4000}), read_back(silent.device, {"read back", 4000, Memory::host});
  Stream stream(silent.device);
  stream.fill(other, 0x3f800000u);  // 1.0f
  stream.fill(other, 0, 0, 40);
  scale.resources.set("Source", other);
  stream.dispatch(scale.kernel, scale.resources, ScalePush{1000, 3}, 16);
  Resources swapped;  // reversed: target -> other
  swapped.set("Source", scale.target);
  swapped.set("Target", other);
  stream.dispatch(scale.kernel, swapped, ScalePush{500, 5}, 8);
  stream.copy(other, read_back, 2000, 0, 2000);
  stream.copy(scale.target, read_back, 2000);
  stream.run();
  const auto result = read_back.read_all<float>();
  CHECK(result[9] == 0);
  CHECK(result[10] == 3);
  CHECK(result[499] == 3);
  CHECK(result[509] == 0);
  CHECK(result[510] == 15);
  CHECK(result[999] == 15);
}

TEST_CASE("a buffer that is recreated under the same name is bound again") {
  test::SilentDevice silent;
  Scale scale(silent.device, "1");
  Stream stream(silent.device);
  for (int round = 0; round < 3; ++round) {
    scale.target = Buffer(silent.device, {"target", 4000});
    stream.dispatch(scale.kernel, scale.resources, ScalePush{1000, static_cast<float>(round)}, 16);
    stream.run();
    CHECK(scale.target.read_all<float>()[100] == 100.0f * static_cast<float>(round) + 1);
  }
}

TEST_CASE("thousands of different bindings work") {
  test::SilentDevice silent;
  Scale scale(silent.device, "0");
  Stream stream(silent.device);
  std::vector<Buffer> targets;
  for (int i = 0; i < 90; ++i) targets.emplace_back(silent.device, BufferDesc{"t", 64});
  const float three[] = {3};
  targets[0].write(std::span<const float>(three));
  // 90 * 89 pairs of source and target, more than the stream caches.
  for (size_t a = 0; a < targets.size(); ++a) {
    for (size_t b = 0; b < targets.size(); ++b) {
      if (a == b) continue;
      Resources pair;
      pair.set("Source", targets[a]);
      pair.set("Target", targets[b]);
      stream.dispatch(scale.kernel, pair, ScalePush{1, 1}, a == 0 ? 1 : 0);
    }
    stream.run();
  }
  // Sets that were evicted and created again.
  for (size_t b = 1; b < targets.size(); ++b) {
    Resources pair;
    pair.set("Source", targets[b]);
    pair.set("Target", targets[0]);
    stream.dispatch(scale.kernel, pair, ScalePush{1, 2}, b == 5 ? 1 : 0);
    pair.set("Source", targets[0]);
    pair.set("Target", targets[b]);
    stream.dispatch(scale.kernel, pair, ScalePush{1, 2}, b > 5 ? 1 : 0);
  }
  stream.run();
  for (size_t b = 0; b < targets.size(); ++b)
    CHECK(targets[b].read_all<float>()[0] == (b == 0 ? 6 : b > 5 ? 12 : 3));
}

TEST_CASE("texel buffers and texture arrays are read: formats, sRGB, filter, repeat, layers") {
  test::SilentDevice silent;
  Device& device = silent.device;
  ShaderCompiler compiler;
  const Kernel kernel(device, compiler, shader("gpu_sample.comp"));
  std::vector<float> texels(4 * 4);
  for (size_t i = 0; i < texels.size(); ++i) texels[i] = 0.25f * static_cast<float>(i);
  Buffer texel_buffer(device, {"texels", texels.size() * 4, Memory::device, true});
  texel_buffer.write(std::span<const float>(texels));
  // Texel centres of a 2 × 2 image are at 1/4 and 3/4; the second sample is between two texels, the third
  // repeats, the fourth is on the other layer.
  const std::vector<vec3> where{{0.25f, 0.25f, 1}, {0.5f, 0.25f, 1}, {1.75f, -0.25f, 1}, {0.25f, 0.25f, 0}};
  Buffer where_buffer(device, {"where", where.size() * sizeof(vec3)});
  where_buffer.write(std::span<const vec3>(where));
  Buffer result(device, {"result", where.size() * 2 * sizeof(vec4)});
  Resources resources;
  resources.set("texels", texel_buffer);
  resources.set("Where", where_buffer);
  resources.set("Result", result);
  Stream stream(device);
  const auto sample = [&](const TextureArray& images) {
    resources.set("images", images);
    stream.dispatch(kernel, resources, uint32_t(where.size()), 1);
    stream.run();
    return result.read_all<vec4>();
  };

  const std::vector<uint8_t> bytes{0, 51, 102, 255, 255, 188, 102, 255, 51, 51, 51, 0, 188, 188, 255, 255};
  TextureArray linear(device, {"linear", 2, 2, 2, TexelFormat::rgba8_unorm});
  linear.write_layer(1, bytes.data());
  auto got = sample(linear);
  for (int i = 0; i < 4; ++i)
    CHECK(got[2 * i] == vec4(texels[4 * i], texels[4 * i + 1], texels[4 * i + 2], texels[4 * i + 3]));
  const auto close = [](vec4 a, vec4 b, float tolerance) { return glm::length(a - b) < tolerance; };
  CHECK(close(got[1], {0, 0.2f, 0.4f, 1}, 1e-3f));
  CHECK(close(got[3], {0.5f, (51 + 188) / 510.0f, 0.4f, 1}, 1e-2f));
  CHECK(close(got[5], {188 / 255.0f, 188 / 255.0f, 1, 1}, 1e-3f));
  CHECK(close(got[7], {0, 0, 0, 0}, 1e-6f));  // never written

  TextureArray srgb(device, {"srgb", 2, 2, 2, TexelFormat::rgba8_srgb});
  srgb.write_layer(1, bytes.data());
  got = sample(srgb);
  const auto decoded = [](float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
  };
  CHECK(close(got[1], {0, decoded(0.2f), decoded(0.4f), 1}, 2e-3f));
  CHECK(close(got[5], {decoded(188 / 255.0f), decoded(188 / 255.0f), 1, 1}, 2e-3f));

  const std::vector<vec4> floats{{1, 1000, -2, 0.5f}, {3, 0, 0, 1}, {0, 0, 0, 0}, {1e5f, 0, 0, 1}};
  TextureArray wide(device, {"float", 2, 2, 2, TexelFormat::rgba32f});
  wide.write_layer(1, floats.data());
  got = sample(wide);
  CHECK(got[1] == floats[0]);
  CHECK(close(got[3], {2, 500, -1, 0.75f}, 3));
  CHECK(got[5] == floats[3]);

  const std::vector<uint16_t> halves{0x3c00, 0x4000, 0xc000, 0x3800, 0, 0, 0, 0, 0, 0, 0, 0, 0x7bff, 0, 0, 0};
  TextureArray half(device, {"half", 2, 2, 2, TexelFormat::rgba16f});
  half.write_layer(1, halves.data());
  got = sample(half);
  CHECK(close(got[1], {1, 2, -2, 0.5f}, 1e-3f));
  CHECK(close(got[5], {65504, 0, 0, 0}, 1));
  CHECK_THAT(error_of([&] { half.write_layer(2, halves.data()); }), Contains("'half'"));
}

TEST_CASE("a texel buffer read as words keeps NaN bits") {
  test::SilentDevice silent;
  ShaderCompiler compiler;
  const Kernel kernel(silent.device, compiler, shader("gpu_words.comp"));
  std::vector<uvec4> words;  // NaNs, denormal numbers, a negative zero
  for (uint32_t i = 0; i < 8; ++i) words.push_back({0x7f800001u + i, i, 0x80000000u, ~i});
  Buffer source(silent.device, {"words", words.size() * 16, Memory::device, true});
  source.write(std::span<const uvec4>(words));
  Buffer result(silent.device, {"result", words.size() * 16});
  Resources resources;
  resources.set("words", source);
  resources.set("Result", result);
  Stream stream(silent.device);
  stream.dispatch(kernel, resources, uint32_t(words.size()), 1);
  stream.run();
  CHECK(result.read_all<uvec4>() == words);
}

TEST_CASE("a texture larger than the staging buffer is uploaded completely") {
  test::SilentDevice silent;
  Device& device = silent.device;
  const uint32_t width = 1024, height = 1100;
  std::vector<vec4> image(size_t(width) * height);
  for (size_t i = 0; i < image.size(); ++i)
    image[i] = vec4(static_cast<float>(i % width), static_cast<float>(i / width), 0, 1);
  TextureArray array(device, {"large", width, height, 1, TexelFormat::rgba32f});
  array.write_layer(0, image.data());
  ShaderCompiler compiler;
  const Kernel kernel(device, compiler, shader("gpu_sample.comp"));
  const std::vector<vec3> where{{10.5f / width, 5.5f / height, 0}, {1000.5f / width, 1099.5f / height, 0}};
  Buffer where_buffer(device, {"where", where.size() * sizeof(vec3)}), result(device, {"result", 64});
  where_buffer.write(std::span<const vec3>(where));
  Buffer texels(device, {"texels", 64, Memory::device, true});
  Resources resources;
  resources.set("texels", texels);
  resources.set("images", array);
  resources.set("Where", where_buffer);
  resources.set("Result", result);
  Stream stream(device);
  stream.fill(texels, 0);
  stream.dispatch(kernel, resources, uint32_t(2), 1);
  stream.run();
  const auto got = result.read_all<vec4>();
  CHECK(glm::length(got[1] - vec4(10, 5, 0, 1)) < 0.1f);
  CHECK(glm::length(got[3] - vec4(1000, 1099, 0, 1)) < 0.1f);
}

TEST_CASE("more workgroups than fit along one axis all run, each index once") {
  test::SilentDevice silent;
  const uint32_t items = 200001;  // with workgroups of 2: 100001 > 65535
  Count count(silent.device, 2, items);
  CHECK(count.kernel.workgroup_size() == 2);
  Stream stream(silent.device);
  stream.fill(count.marks, 0);
  stream.fill(count.total, 0);
  stream.dispatch(count.kernel, count.resources, CountPush{items, 0}, groups_for(items, 2));
  stream.run();
  CHECK(count.all_marked(1));
  CHECK(count.total.read_all<uint32_t>()[0] == items);
}

TEST_CASE("an indirect dispatch reads counts written by an earlier one, also beyond one axis") {
  test::SilentDevice silent;
  const uint32_t items = 200001;
  Count count(silent.device, 2, items, 7);
  Stream stream(silent.device);
  stream.fill(count.marks, 0);
  stream.fill(count.total, 0);
  stream.dispatch(count.kernel, count.resources, CountPush{0, groups_for(items, 2)}, 1);
  stream.dispatch_indirect(count.kernel, count.resources, CountPush{items, 0}, count.arguments, 0);
  // The indirect dispatch has set the next count to 0 workgroups.
  stream.dispatch_indirect(count.kernel, count.resources, CountPush{items, 1}, count.arguments, 0);
  stream.run();
  CHECK(count.all_marked(7));
  CHECK(count.total.read_all<uint32_t>()[0] == items);
  CHECK(count.arguments.read_all<uint32_t>() == std::vector<uint32_t>{0, 1, 1});
  CHECK_THAT(error_of([&] {
               stream.dispatch_indirect(count.kernel, count.resources, CountPush{}, count.arguments, 4);
             }),
             Contains("'arguments'"));
}

TEST_CASE("0 workgroups run nothing") {
  test::SilentDevice silent;
  Count count(silent.device, 64, 64);
  Stream stream(silent.device);
  stream.run();
  stream.fill(count.marks, 5);
  stream.dispatch(count.kernel, count.resources, CountPush{64, 0}, 0);
  stream.run();
  stream.run();
  CHECK(count.all_marked(5));
}

TEST_CASE("a missing, empty or mismatched resource is named") {
  test::SilentDevice silent;
  Scale scale(silent.device);
  Stream stream(silent.device);
  const auto refusal = [&] {
    return error_of([&] { stream.dispatch(scale.kernel, scale.resources, ScalePush{}, 1); });
  };
  scale.resources.remove("Source");
  CHECK_THAT(refusal(), Contains("gpu_scale.comp") && Contains("'Source'"));
  const Buffer never_made;
  scale.resources.set("Source", never_made);
  CHECK_THAT(refusal(), Contains("'Source'") && Contains("never made"));
  const TextureArray image(silent.device, {"image", 1, 1, 1});
  scale.resources.set("Source", image);
  CHECK_THAT(refusal(), Contains("'Source'") && Contains("must be a buffer"));
  scale.resources.set("Source", scale.source);
  CHECK_THAT(error_of([&] { stream.dispatch(scale.kernel, scale.resources, uint32_t(1), 1); }),
             Contains("gpu_scale.comp") && Contains("8 bytes, 4 were given"));
  CHECK_THAT(error_of([&] { stream.dispatch(Kernel(), scale.resources, ScalePush{}, 1); }),
             Contains("never made"));
  CHECK_THAT(error_of([&] { stream.fill(scale.source, 0, 4000, 4); }), Contains("'source'"));
  CHECK_THAT(error_of([&] { stream.copy(scale.source, scale.target, 8, 3996); }), Contains("'source'"));
  // No refusal invalidates valid work.
  stream.dispatch(scale.kernel, scale.resources, ScalePush{1000, 1}, 16);
  stream.run();
  CHECK(scale.target.read_all<float>()[7] == 8.5f);

  ShaderCompiler compiler;
  const Kernel sampler(silent.device, compiler, shader("gpu_sample.comp"));
  Resources resources;
  for (const char* name : {"texels", "Where", "Result"}) resources.set(name, scale.source);
  resources.set("images", image);
  CHECK_THAT(error_of([&] { stream.dispatch(sampler, resources, uint32_t(1), 1); }),
             Contains("'texels'") && Contains("texel = true"));
}

TEST_CASE("a kernel without push constants runs, and may state its own version") {
  test::SilentDevice silent;
  ShaderCompiler compiler;
  const Kernel kernel(silent.device, compiler, shader("gpu_version.comp"));
  CHECK(kernel.push_constant_bytes() == 0);
  Buffer target(silent.device, {"target", 4});
  Resources resources;
  resources.set("Target", target);
  Stream stream(silent.device);
  stream.dispatch(kernel, resources, nullptr, 0, 1);
  stream.run();
  CHECK(target.read_all<float>()[0] == 1);
}

TEST_CASE("64-bit sums by atomics are exact") {
  test::SilentDevice silent;
  if (!silent.device.info().optional.int64_atomics) return;
  ShaderCompiler compiler;
  const Kernel kernel(silent.device, compiler, shader("gpu_int64.comp"));
  Buffer sum(silent.device, {"sum", 8});
  Resources resources;
  resources.set("Sum", sum);
  Stream stream(silent.device);
  stream.fill(sum, 0);
  stream.dispatch(kernel, resources, nullptr, 0, 100);  // 200 times each power of two from 2^0 to 2^31
  stream.run();
  CHECK(sum.read_all<uint64_t>()[0] == 200 * ((1ull << 32) - 1));
}

TEST_CASE("device time is kept per stage, in the order of first use, over any number of dispatches") {
  test::SilentDevice silent;
  if (silent.device.info().limits.timestamp_ns == 0) return;
  Scale scale(silent.device);
  Stream stream(silent.device);
  CHECK(stream.take_times().empty());
  for (int i = 0; i < 700; ++i) {  // more than one pool of queries holds
    stream.dispatch(scale.kernel, scale.resources, ScalePush{1000, 1}, 16, i % 2 ? "odd" : "even");
    stream.dispatch(scale.kernel, scale.resources, ScalePush{1000, 1}, 16);
  }
  stream.run();
  stream.dispatch(scale.kernel, scale.resources, ScalePush{1000, 1}, 16, "late");
  stream.run();
  const auto times = stream.take_times();
  REQUIRE(times.size() == 3);
  CHECK(times[0].stage == "even");
  CHECK(times[1].stage == "odd");
  CHECK(times[2].stage == "late");
  for (const auto& t : times) CHECK(t.milliseconds > 0);
  CHECK(times[0].milliseconds < 60000);
  CHECK(stream.take_times().empty());
}

}  // namespace gpu_stream_tests
