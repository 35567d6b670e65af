// Stock models are found by name, in the order of the folders, and an error says what there is.
#include "model/stock_models.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/system.h"
#include "platform.h"
#include "temporary_folder.h"

using namespace focal;
namespace fs = std::filesystem;

namespace {

struct Folder : focal_test::TemporaryFolder {
  void put(const std::string& name) const {
    fs::create_directories((path / name).parent_path());
    std::ofstream(path / name) << "model";
  }
};

// FOCAL_MODELS while it lives.
struct Variable {
  explicit Variable(const std::string& value) { focal_test::set_variable("FOCAL_MODELS", value); }
  ~Variable() { focal_test::set_variable("FOCAL_MODELS", ""); }
};

}  // namespace

TEST_CASE("folders: the host's, those of FOCAL_MODELS, those of the installation") {
  const std::string between(1, list_separator);
  const Variable variable(between + "/one" + between + between + "/two");
  const auto folders = stock_folders("/host", "/opt/focal/lib");
  REQUIRE(folders.size() == 7);
  CHECK(folders[0] == "/host");
  CHECK(folders[1] == "/one");
  CHECK(folders[2] == "/two");
  CHECK(folders[3] == "/opt/focal/lib/models");
  CHECK(folders[4] == "/opt/focal/lib/../models");
  CHECK(folders[5] == "/opt/focal/lib/../share/focal/models");
  CHECK(folders[6] == "/opt/focal/lib/../../share/focal/models");
  CHECK(stock_folders({}, {}).size() == 2);
}

TEST_CASE("models: by name, the first folder counts, other files and missing folders hold none") {
  const Folder first, second;
  first.put("quadruped.focal");
  second.put("quadruped.focal");
  second.put("hand.focal");
  second.put("README.txt");
  second.put("folder.focal/x");
  const std::vector<std::string> folders = {"/no/such/folder", first.path.string(), second.path.string()};
  const auto models = stock_models_in(folders);
  REQUIRE(models.size() == 2);
  CHECK(models[0].name == "hand");
  CHECK(models[1].path == first.path.string() + "/quadruped.focal");
  CHECK(stock_model(models, "hand").path == second.path.string() + "/hand.focal");
}

TEST_CASE("an unknown name lists those that are there; without any it says how to get some") {
  const std::vector<StockModel> models = {{"hand", "/hand.focal"}, {"humanoid", "/humanoid.focal"}};
  const auto hint_of = [](std::span<const StockModel> all) {
    try {
      stock_model(all, "dragon");
    } catch (const Error& error) {
      CHECK(error.status() == Status::file_not_found);
      CHECK(std::string(error.what()) == "there is no stock model 'dragon'");
      return std::string(error.hint());
    }
    return std::string();
  };
  CHECK(hint_of(models) == "stock models: hand, humanoid");
  CHECK(hint_of({}).find("samples/stock/make.sh") != std::string::npos);
}
