// SPDX-License-Identifier: Apache-2.0
// A server by a script.
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

namespace corridor::testing_support {

// Notes what it is asked, and answers by the script on a thread of its own.
template <typename Request>
class ScriptedServer {
 public:
  using Decode = Request (*)(ByteView);
  // The reply's bytes; nothing: no answer.
  using Script = std::function<std::optional<Body>(const Request&)>;

  ScriptedServer(Address address, std::string run_id, Decode decode, Script script)
      : address_(std::move(address)),
        run_id_(std::move(run_id)),
        decode_(decode),
        script_(std::move(script)),
        thread_([this] { serve(); }) {}
  ~ScriptedServer() { end(); }
  ScriptedServer(const ScriptedServer&) = delete;
  ScriptedServer& operator=(const ScriptedServer&) = delete;

  const Address& address() const { return address_; }
  // What it was asked. It has ended then.
  const std::vector<Request>& end() {
    end_ = true;
    if (thread_.joinable()) thread_.join();
    return requests_;
  }

 private:
  void serve() {
    Server server(address_, run_id_);
    while (!end_) {
      const auto request = server.receive(Duration{5});
      if (!request) continue;
      requests_.push_back(decode_(request->body));
      if (const auto reply = script_(requests_.back())) server.reply(*request, *reply);
    }
  }

  const Address address_;
  const std::string run_id_;
  const Decode decode_;
  const Script script_;
  std::atomic<bool> end_ = false;
  std::vector<Request> requests_;
  std::thread thread_;
};

}  // namespace corridor::testing_support
