#include "gltf/document.h"

#include <utility>

#include "base/atomic_file.h"
#include "gltf/fields.h"
#include "gltf/opened.h"
#include "gltf/preflight.h"
#include "gltf/text.h"

namespace focal {
namespace {

std::vector<std::string> uris_beside(const nlohmann::json& root) {
  std::vector<std::string> result;
  for (const char* key : {"buffers", "images"}) {
    for (const nlohmann::json& element : list(root, key)) {
      const nlohmann::json* uri = element.is_object() ? member(element, "uri") : nullptr;
      if (!uri || !uri->is_string() || is_data_uri(uri->get_ref<const std::string&>())) continue;
      result.push_back(uri->get<std::string>());
    }
  }
  return result;
}

}  // namespace

GltfDocument::GltfDocument(std::vector<std::byte> bytes, const GltfReadParams& params,
                           std::optional<std::filesystem::path> folder) {
  auto opened = std::make_shared<Opened>();
  opened->bytes = std::move(bytes);
  opened->params = params;
  opened->folder = std::move(folder);
  if (params.allow_external_files) opened->readable_folder = opened->folder;
  opened->container = open_container(opened->bytes, params.limits);
  JsonDocument document = parse_gltf(opened->container, params.limits, params.lenient);
  opened->uris = uris_beside(document.root());
  opened->view = view_of(document.root());
  opened_ = std::move(opened);
}

GltfDocument GltfDocument::open(const std::filesystem::path& path, const GltfReadParams& params) {
  return GltfDocument(read_file(path, params.limits.file_bytes), params, path.parent_path());
}

GltfDocument::GltfDocument(const GltfDocument& other) : opened_(other.opened_) {}
GltfDocument::GltfDocument(GltfDocument&&) noexcept = default;
GltfDocument& GltfDocument::operator=(GltfDocument&&) noexcept = default;
GltfDocument::~GltfDocument() = default;

bool GltfDocument::is_binary() const { return opened_->container.binary; }

const std::optional<std::filesystem::path>& GltfDocument::folder() const { return opened_->folder; }

bool GltfDocument::reads_files_beside() const { return opened_->readable_folder.has_value(); }

std::vector<std::filesystem::path> GltfDocument::files_beside() const {
  std::vector<std::filesystem::path> result;
  for (const std::string& uri : opened_->uris)
    if (auto path = path_beside(uri)) result.push_back(std::move(*path));
  return result;
}

GltfDocument::Edited& GltfDocument::edited() {
  const GltfLimits& limits = opened_->params.limits;
  if (!edited_)
    edited_.reset(new Edited{OrderedJsonDocument(opened_->container.json,
                                                 {.depth = limits.json_depth, .values = limits.json_values}),
                             {}});
  return *edited_;
}

std::vector<std::byte> GltfDocument::bytes() const {
  if (!edited_) return opened_->bytes;
  const auto& json = opened_->container.json;
  const std::string_view before(reinterpret_cast<const char*>(json.data()), json.size());
  const bool indented = before.find('\n') != std::string_view::npos;
  return with_content(
      opened_->container,
      edited_->document.root().dump(indented ? 2 : -1, ' ', false, nlohmann::json::error_handler_t::replace),
      edited_->bin);
}

}  // namespace focal
