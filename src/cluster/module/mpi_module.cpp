// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Sends and receives messages with MPI-3. A message is sent as its length followed by pieces, because MPI counts bytes
// with an int.
#include <mpi.h>

#include <algorithm>
#include <cstdint>
#include <list>
#include <stdexcept>
#include <utility>

#include "cluster/mpi_functions.h"

namespace lanthorn {

namespace {

constexpr int length_tag = 1, piece_tag = 2;
constexpr std::size_t piece_bytes = std::size_t{1} << 28;

void require(int code, const char* what) {
  if (code != MPI_SUCCESS) throw std::runtime_error(what);
}

// A message that is being sent. MPI reads these bytes until its requests complete, so they must not move.
struct Sending {
  std::uint64_t length;
  std::vector<std::byte> bytes;
  std::vector<MPI_Request> requests;
};
std::list<Sending>& sending() {
  static std::list<Sending> list;
  return list;
}

template <class Body>
void for_each_piece(std::size_t length, Body&& body) {
  for (std::size_t begin = 0; begin < length; begin += piece_bytes)
    body(begin, static_cast<int>(std::min(piece_bytes, length - begin)));
}

void send(int to, std::vector<std::byte> bytes) {
  Sending& s = sending().emplace_back();
  s.bytes = std::move(bytes);
  s.length = s.bytes.size();
  MPI_Request request = MPI_REQUEST_NULL;
  require(MPI_Isend(&s.length, 1, MPI_UINT64_T, to, length_tag, MPI_COMM_WORLD, &request), "MPI_Isend");
  s.requests.push_back(request);
  for_each_piece(s.bytes.size(), [&](std::size_t begin, int count) {
    require(MPI_Isend(&s.bytes[begin], count, MPI_BYTE, to, piece_tag, MPI_COMM_WORLD, &request), "MPI_Isend");
    s.requests.push_back(request);
  });
}

void move_on() {
  auto& list = sending();
  for (auto s = list.begin(); s != list.end();) {
    int is_done = 0;
    require(MPI_Testall(static_cast<int>(s->requests.size()), s->requests.data(), &is_done, MPI_STATUSES_IGNORE),
            "MPI_Testall");
    s = is_done != 0 ? list.erase(s) : std::next(s);
  }
}

std::optional<TeamMessage> receive() {
  move_on();
  int has_come = 0;
  MPI_Status status;
  require(MPI_Iprobe(MPI_ANY_SOURCE, length_tag, MPI_COMM_WORLD, &has_come, &status), "MPI_Iprobe");
  if (has_come == 0) return std::nullopt;
  TeamMessage message;
  message.from = status.MPI_SOURCE;
  std::uint64_t length = 0;
  require(MPI_Recv(&length, 1, MPI_UINT64_T, message.from, length_tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE), "MPI_Recv");
  message.bytes.resize(length);
  for_each_piece(length, [&](std::size_t begin, int count) {
    require(
        MPI_Recv(&message.bytes[begin], count, MPI_BYTE, message.from, piece_tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE),
        "MPI_Recv");
  });
  return message;
}

bool all_sent() {
  move_on();
  return sending().empty();
}

TeamLink join() {
  int provided = 0;
  require(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided), "MPI_Init_thread");
  if (provided < MPI_THREAD_SERIALIZED) throw std::runtime_error("this MPI cannot be called from different threads");
  TeamLink link{.send = send, .receive = receive, .all_sent = all_sent};
  MPI_Comm_rank(MPI_COMM_WORLD, &link.rank);
  MPI_Comm_size(MPI_COMM_WORLD, &link.size);
  return link;
}

void leave() { MPI_Finalize(); }
void abort(int exit_code) { MPI_Abort(MPI_COMM_WORLD, exit_code); }

}  // namespace

extern "C" const MpiFunctions* lanthorn_mpi_functions() {
  static constexpr MpiFunctions functions{join, leave, abort};
  return &functions;
}

}  // namespace lanthorn
