// A headless Chromium, driven through the DevTools protocol on a pipe. See browser.h.
#include "browser.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <thread>

namespace {

using nlohmann::json;
constexpr int patience = 60'000;  // ms for an answer: a busy machine draws slowly without a GPU

std::string decoded(const std::string& base64) {
  std::string bytes;
  uint32_t bits = 0;
  int count = 0;
  for (const char c : base64) {
    const size_t digit =
        std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/").find(c);
    if (digit == std::string_view::npos) break;
    bits = bits << 6 | static_cast<uint32_t>(digit);
    if ((count += 6) >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 0xff);
  }
  return bytes;
}

// In the child: the protocol's ends become the descriptors that Chromium looks for, its own words go nowhere.
[[noreturn]] void become_browser(const std::string& program, int in, int out, const std::string& profile) {
  ::setpgid(0, 0);
  const int high_in = ::fcntl(in, F_DUPFD, 10), high_out = ::fcntl(out, F_DUPFD, 10);
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (const int descriptor : {0, 1, 2}) ::dup2(nowhere, descriptor);
  ::dup2(high_in, 3);
  ::dup2(high_out, 4);
  for (int descriptor = 5; descriptor < 64; ++descriptor) ::close(descriptor);
  const std::string folder = "--user-data-dir=" + profile;
  ::execl(program.c_str(), program.c_str(), "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic",
          "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
          "--disable-dev-shm-usage", "--hide-scrollbars", "--use-gl=angle", "--use-angle=swiftshader",
          "--enable-unsafe-swiftshader", "--remote-debugging-pipe", folder.c_str(), "about:blank", nullptr);
  ::_exit(127);
}

}  // namespace

std::optional<std::string> Browser::program() {
  for (const char* name : {"/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"}) {
    if (std::filesystem::exists(name)) return name;
  }
  return {};
}

Browser::Browser(const std::string& program) {
  int down[2], up[2];
  if (::pipe(down) != 0 || ::pipe(up) != 0) throw std::runtime_error("no pipe for the browser");
  ::signal(SIGPIPE, SIG_IGN);
  process_ = ::fork();
  if (process_ == 0) become_browser(program, down[0], up[1], profile_.path.string());
  ::close(down[0]);
  ::close(up[1]);
  to_ = down[1];
  from_ = up[0];
  const json target = call("Target.createTarget", {{"url", "about:blank"}});
  session_ =
      call("Target.attachToTarget", {{"targetId", target["targetId"]}, {"flatten", true}})["sessionId"];
  for (const char* domain : {"Page", "Runtime", "Log", "Network"})
    call(std::string(domain) + ".enable", json::object());
}

Browser::~Browser() {
  ::close(to_);  // which it takes as a goodbye
  for (int wait = 0; wait < 100; ++wait) {
    if (::waitpid(process_, nullptr, WNOHANG) == process_) process_ = -1;
    if (process_ < 0) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  if (process_ > 0) {
    ::kill(-process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  ::close(from_);
}

json Browser::receive() {
  for (;;) {
    if (const size_t end = unread_.find('\0'); end != std::string::npos) {
      const json message = json::parse(unread_.substr(0, end));
      unread_.erase(0, end + 1);
      return message;
    }
    pollfd ready{from_, POLLIN, 0};
    if (::poll(&ready, 1, patience) != 1) throw std::runtime_error("the browser does not answer");
    char block[65536];
    const ssize_t size = ::read(from_, block, sizeof block);
    if (size <= 0) throw std::runtime_error("the browser has gone");
    unread_.append(block, static_cast<size_t>(size));
  }
}

json Browser::call(const std::string& method, const json& parameters) {
  json message = {{"id", ++last_id_}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) message["sessionId"] = session_;
  const std::string text = message.dump() + '\0';
  for (size_t sent = 0; sent < text.size();) {
    const ssize_t size = ::write(to_, text.data() + sent, text.size() - sent);
    if (size <= 0) throw std::runtime_error("the browser does not listen");
    sent += static_cast<size_t>(size);
  }
  for (;;) {
    const json answer = receive();
    if (answer.value("id", 0) != last_id_) {
      note(answer);
      continue;
    }
    if (answer.contains("error")) throw std::runtime_error(method + ": " + answer["error"].dump());
    return answer["result"];
  }
}

void Browser::note(const json& event) {
  const std::string method = event.value("method", "");
  if (method == "Network.requestWillBeSent") requests_.push_back(event["params"]["request"]["url"]);
  if (method == "Runtime.exceptionThrown") complaints_.push_back(event["params"]["exceptionDetails"].dump());
  if (method == "Log.entryAdded" && event["params"]["entry"]["level"] != "verbose") {
    complaints_.push_back(event["params"]["entry"].dump());
  }
  if (method == "Runtime.consoleAPICalled") {
    const std::string kind = event["params"]["type"];
    if (kind == "error" || kind == "warning" || kind == "assert")
      complaints_.push_back(event["params"]["args"].dump());
  }
}

void Browser::open(const std::string& address, const std::string& ready) {
  call("Page.navigate",
       {{"url", "about:blank"}});  // or a change of the part after # alone would not load anew
  requests_.clear();
  complaints_.clear();
  call("Page.navigate", {{"url", address}});
  for (int wait = 0; wait < patience / 100; ++wait) {
    if (evaluate(ready) == true) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  throw std::runtime_error("the page does not become ready" +
                           (complaints_.empty() ? "" : ": " + complaints_[0]));
}

json Browser::evaluate(const std::string& expression) {
  const json answer =
      call("Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
  if (answer.contains("exceptionDetails"))
    throw std::runtime_error(expression + ": " + answer["exceptionDetails"].dump());
  return answer["result"].value("value", json());
}

void Browser::press(const std::string& key) {
  json event = {{"type", "keyDown"}, {"key", key}};
  if (key.size() == 1) event["text"] = key;
  if (key == "Enter") event["text"] = "\r", event["windowsVirtualKeyCode"] = 13;
  if (key == "Tab") event["windowsVirtualKeyCode"] = 9;
  call("Input.dispatchKeyEvent", event);
  event["type"] = "keyUp";
  event.erase("text");
  call("Input.dispatchKeyEvent", event);
}

void Browser::size(int width, int height) {
  call("Emulation.setDeviceMetricsOverride",
       {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
}

void Browser::dark(bool on) {
  call("Emulation.setEmulatedMedia",
       {{"features", {{{"name", "prefers-color-scheme"}, {"value", on ? "dark" : "light"}}}}});
}

void Browser::save_picture(const std::string& path) {
  const json picture = call("Page.captureScreenshot", {{"format", "png"}, {"captureBeyondViewport", true}});
  std::ofstream(path, std::ios::binary) << decoded(picture["data"]);
}
