// A replay server by a script.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "proto/wire/codec.h"
#include "proto/wire/endpoint.h"
#include "tests/learner/small_run.h"

namespace corridor::learner {

// The reply's bytes; nothing: no answer.
using Script = std::function<std::optional<Body>(const ReplayRequest&)>;

// Notes what it is asked, and answers by the script on a thread of its own.
class ScriptedServer {
 public:
  explicit ScriptedServer(Script script)
      : script_(std::move(script)), thread_([this] { serve(); }) {}
  ~ScriptedServer() {
    end_ = true;
    thread_.join();
  }
  const std::string& address() const { return address_; }
  // Once the server has ended.
  const std::vector<ReplayRequest>& end() {
    end_ = true;
    thread_.join();
    thread_ = std::thread([] {});
    return requests_;
  }

 private:
  void serve() {
    Server server(address_, kRunId);
    while (!end_) {
      const auto request = server.receive(Duration{5});
      if (!request) continue;
      requests_.push_back(decode_replay_request(request->body));
      if (const auto reply = script_(requests_.back())) server.reply(*request, *reply);
    }
  }

  const std::string address_ = fresh_address("scripted");
  Script script_;
  std::atomic<bool> end_ = false;
  std::vector<ReplayRequest> requests_;
  std::thread thread_;
};

}  // namespace corridor::learner
