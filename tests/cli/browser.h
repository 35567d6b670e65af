// A headless Chromium, driven through the DevTools protocol on a pipe: what a page asks for, complains about and draws.
#pragma once
#include <sys/types.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scratch_folder.h"

class Browser {
 public:
  // The program, or nothing where this machine has none.
  static std::optional<std::string> program();

  explicit Browser(const std::string& program);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  // Opens the address and waits until `ready`, an expression, is true. Forgets what was noted before.
  void open(const std::string& address, const std::string& ready);
  nlohmann::json evaluate(const std::string& expression);
  void press(const std::string& key);  // as KeyboardEvent.key names it
  void size(int width, int height);
  void dark(bool on);
  void save_picture(const std::string& path);  // PNG of the whole page

  const std::vector<std::string>& requests() const { return requests_; }  // addresses asked for
  const std::vector<std::string>& complaints() const {
    return complaints_;
  }  // errors and warnings of the console

 private:
  nlohmann::json call(const std::string& method, const nlohmann::json& parameters);
  nlohmann::json receive();
  void note(const nlohmann::json& event);

  ScratchFolder profile_;
  pid_t process_ = -1;
  int to_ = -1, from_ = -1;
  int last_id_ = 0;
  std::string session_, unread_;
  std::vector<std::string> requests_, complaints_;
};
