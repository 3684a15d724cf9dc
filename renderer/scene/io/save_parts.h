#pragma once
// The steps of save(): each writes the edits of one subject into the document's JSON.
#include <filesystem>
#include <string>
#include <vector>

#include "scene/io/json_edit.h"
#include "scene/io/save.h"

namespace lucerna::scene {

/// Writes the lights of `edited` that differ from those of `loaded`, removes those that are gone, and adds
/// the new ones as nodes of the default scene. Lights keep their nodes. A light that moves and whose node
/// holds something else gets a new node there.
void write_lights(EditedJson& root, const Scene& loaded, const Scene& edited);

/// Writes places and visibility of instances that differ. A node that holds something else besides the mesh
/// gets a child for it; EXT_mesh_gpu_instancing becomes nodes. `notes`: what other programs will not see.
/// Throws Error located at the object: too many of them.
void write_objects(EditedJson& root, const Scene& loaded, const Scene& edited,
                   std::vector<std::string>& notes);

/// Adds cameras, or replaces those of the same name. Positions are relative to `origin` of the file.
void write_cameras(EditedJson& root, const glm::dvec3& origin, const std::vector<Camera>& cameras);

/// Folders of the source and of the saved file, absolute.
struct Folders {
  std::filesystem::path from, to;
  bool same() const { return from == to; }
};

/// Writes numbers of materials that differ, and textures from other sources. Throws Error located at a
/// texture's file that cannot be read.
void write_materials(EditedJson& root, const SaveRequest& request, const Folders& folders);

/// extras.lucerna of the default scene: environment and settings. Both are left out if they are what the
/// source's extras and, in the same folder, settings.json give.
void write_scene_extras(EditedJson& root, const SaveRequest& request, const Folders& folders);

/// The URI, relative to the new folder, of a file that `uri` names from the old one (as resolve_uri() reads
/// it). Data, absolute paths and other schemes stay.
std::string moved_uri(const std::string& uri, const Folders& folders);
/// The file that a relative URI names: percent-decoded, or as written if only that exists.
std::filesystem::path file_of(const std::string& uri, const std::filesystem::path& folder);
/// The relative URI of a file.
std::string uri_of(const std::filesystem::path& file, const std::filesystem::path& folder);
/// Makes all references of the document relative to the new folder: of buffers, images, extensions and
/// extras.environment.
void move_uris(EditedJson& root, const Folders& folders);
/// Number of references to files outside the document's folder.
size_t count_outside(EditedJson root);

/// Puts buffers, and PNG and JPEG images, into one binary chunk, which is returned. Images that cannot be
/// read, or may not (SaveRequest::outside), keep their URIs. Files are read from folders.from. Throws Error
/// at `where` if a buffer cannot be read.
std::vector<uint8_t> embed_files(EditedJson& root, const Folders& folders, bool outside,
                                 const std::string& where);

}  // namespace lucerna::scene
