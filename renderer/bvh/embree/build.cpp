#include "bvh/embree/build.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <new>

#include "base/error.h"
#include "base/log.h"
#include "bvh/embree/embree_device.h"

namespace lucerna::bvh {

namespace {

// Embree allocates these in its own arena; `count` distinguishes them (0: an inner node).
struct BuiltNode {
  uint32_t count = 0;
};
struct BuiltInner : BuiltNode {
  BuiltNode* child[2] = {};
  Box box[2];
};
struct BuiltLeaf : BuiltNode {
  Reference* references = nullptr;
};

struct Job {
  const Triangles& triangles;
  const BuildOptions& options;
  std::mutex mutex;
  float done = 0;
  bool cancelled = false;
};

Box box_of(const RTCBounds& b) {
  return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}
Box box_of(const RTCBuildPrimitive& b) {
  return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}
RTCBounds bounds_of(const Box& b) { return {b.lo.x, b.lo.y, b.lo.z, 0, b.hi.x, b.hi.y, b.hi.z, 0}; }

void* create_node(RTCThreadLocalAllocator allocator, unsigned, void*) {
  return static_cast<BuiltNode*>(new (rtcThreadLocalAlloc(allocator, sizeof(BuiltInner), 16)) BuiltInner);
}

void set_children(void* node, void** children, unsigned count, void*) {
  auto* inner = static_cast<BuiltInner*>(static_cast<BuiltNode*>(node));
  for (unsigned i = 0; i < count; ++i) inner->child[i] = static_cast<BuiltNode*>(children[i]);
}

void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
  auto* inner = static_cast<BuiltInner*>(static_cast<BuiltNode*>(node));
  for (unsigned i = 0; i < count; ++i) inner->box[i] = box_of(*bounds[i]);
}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count,
                  void*) {
  auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(BuiltLeaf), 16)) BuiltLeaf;
  leaf->count = static_cast<uint32_t>(count);
  leaf->references =
      static_cast<Reference*>(rtcThreadLocalAlloc(allocator, count * sizeof(Reference), alignof(Reference)));
  for (size_t i = 0; i < count; ++i)
    new (leaf->references + i) Reference{box_of(primitives[i]), primitives[i].primID};
  return static_cast<BuiltNode*>(leaf);
}

/// Boxes of the parts of a triangle on both sides of a plane, within its already clipped box. Each includes
/// the margin of the triangle's test, so that parts of large triangles do not become smaller than the
/// rounding of ray positions.
void split(const RTCBuildPrimitive* primitive, unsigned axis, float position, RTCBounds* left,
           RTCBounds* right, void* user) {
  const Job& job = *static_cast<Job*>(user);
  const int k = static_cast<int>(axis);
  const vec3* p = &job.triangles.vertices[3 * size_t{primitive->primID}];
  Box low, high;
  for (int i = 0; i < 3; ++i) {
    const vec3 &a = p[i], &b = p[(i + 1) % 3];
    if (a[k] <= position) low.grow(a);
    if (a[k] >= position) high.grow(a);
    if ((a[k] < position) == (b[k] < position)) continue;
    const float s = (position - a[k]) / (b[k] - a[k]);
    const vec3 cut = a + s * (b - a);
    // The rounding of the cut must not let the parts lose anything of the triangle.
    const vec3 slack = 4e-7f * glm::max(glm::abs(a), glm::abs(b));
    for (Box* box : {&low, &high}) box->grow(cut - slack), box->grow(cut + slack);
  }
  low.hi[k] = high.lo[k] = position;
  const Box whole = box_of(*primitive);
  const float margin = margin_of(p);
  const auto clip = [&](const Box& exact) {
    const Box part = grown(exact, margin);
    const Box clipped{glm::max(part.lo, whole.lo), glm::min(part.hi, whole.hi)};
    return clipped.empty() ? whole : clipped;
  };
  *left = bounds_of(clip(low)), *right = bounds_of(clip(high));
}

bool progress(void* user, double done) {
  Job& job = *static_cast<Job*>(user);
  const std::lock_guard lock(job.mutex);
  job.done = std::clamp(static_cast<float>(done), job.done, 1.0f);
  job.cancelled = job.cancelled || !job.options.progress(job.done);
  return !job.cancelled;
}

/// Embree's pointers into our indices, parents before children and references in leaf order.
Tree collect(const BuiltNode* root, const Box& root_box) {
  Tree tree;
  struct Item {
    const BuiltNode* node;
    Box box;
    uint32_t parent, side;
  };
  std::vector<Item> stack{{root, root_box, Tree::k_leaf, 0}};
  while (!stack.empty()) {
    const Item item = stack.back();
    stack.pop_back();
    const auto index = static_cast<uint32_t>(tree.nodes.size());
    const auto first = static_cast<uint32_t>(tree.references.size());
    tree.nodes.push_back({item.box, {Tree::k_leaf, Tree::k_leaf}, first, item.node->count});
    if (item.parent != Tree::k_leaf) tree.nodes[item.parent].child[item.side] = index;
    if (item.node->count > 0) {
      const auto* leaf = static_cast<const BuiltLeaf*>(item.node);
      tree.references.insert(tree.references.end(), leaf->references, leaf->references + leaf->count);
      continue;
    }
    // The larger child goes first, right behind its parent: it is the likelier one to be visited next.
    const auto* inner = static_cast<const BuiltInner*>(item.node);
    const auto area = [](const Box& b) {
      const vec3 s = b.size();
      return s.x * s.y + s.y * s.z + s.z * s.x;
    };
    const int large = area(inner->box[0]) >= area(inner->box[1]) ? 0 : 1;
    stack.push_back({inner->child[1 - large], inner->box[1 - large], index, 1});
    stack.push_back({inner->child[large], inner->box[large], index, 0});
  }
  for (size_t i = tree.nodes.size(); i-- > 0;) {
    Tree::Node& node = tree.nodes[i];
    if (!node.leaf()) node.count = tree.nodes[node.child[0]].count + tree.nodes[node.child[1]].count;
  }
  return tree;
}

}  // namespace

Tree build_tree(const Triangles& triangles, const BuildOptions& options) {
  std::vector<Reference> references = references_of(triangles);
  if (references.empty()) return {};
  if (references.size() > k_max_triangles)
    throw_error("bvh", "{} triangles, of which the device layout holds at most {}", references.size(),
                k_max_triangles);

  Box bounds;
  std::vector<RTCBuildPrimitive> primitives;
  const size_t count = references.size();
  size_t capacity = count;
  if (options.spatial_splits)
    capacity = std::min<size_t>(
        k_max_triangles, count + static_cast<size_t>(options.split_budget * static_cast<float>(count)));
  primitives.reserve(capacity);
  for (const Reference& r : references) {
    bounds.grow(r.box);
    primitives.push_back({r.box.lo.x, r.box.lo.y, r.box.lo.z, 0, r.box.hi.x, r.box.hi.y, r.box.hi.z, r.prim});
  }
  primitives.resize(capacity);

  const EmbreeDevice device = new_embree_device(options.threads);
  const EmbreeBvh bvh(rtcNewBVH(device.get()));
  Job job{triangles, options, {}, 0, false};
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.buildQuality = options.spatial_splits ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
  arguments.maxBranchingFactor = 2;
  // limit_depth() bounds the stack's depth, at less cost than Embree's large leaves; Embree's builder fails
  // if its own limit is reached.
  arguments.maxDepth = 1024;
  arguments.sahBlockSize = 1;
  arguments.minLeafSize = 1;
  arguments.maxLeafSize = std::min(options.max_leaf, k_largest_leaf);
  arguments.traversalCost = 1.0f;
  arguments.intersectionCost = options.intersection_cost;
  arguments.bvh = bvh.get();
  arguments.primitives = primitives.data();
  arguments.primitiveCount = count;
  arguments.primitiveArrayCapacity = capacity;
  arguments.createNode = create_node;
  arguments.setNodeChildren = set_children;
  arguments.setNodeBounds = set_bounds;
  arguments.createLeaf = create_leaf;
  arguments.splitPrimitive = options.spatial_splits ? split : nullptr;
  arguments.buildProgress = options.progress ? progress : nullptr;
  arguments.userPtr = &job;
  const auto* root = static_cast<const BuiltNode*>(rtcBuildBVH(&arguments));
  // A small build may be over before Embree sees the refusal.
  if (job.cancelled) throw_error("bvh", "building the tree of {} triangles: cancelled", count);
  if (root) return collect(root, bounds);

  const std::string error = embree_error(device.get());
  if (error == "out of memory") throw_error("bvh", "building the tree of {} triangles: {}", count, error);
  log::warning("bvh: building failed ({}); the tree is split at medians and slower to trace", error);
  return build_median(std::move(references));
}

BvhData build(const Triangles& triangles, const BuildOptions& options) {
  return flatten(build_tree(triangles, options), triangles);
}

}  // namespace lucerna::bvh
