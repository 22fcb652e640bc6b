// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/team/member.h"

#include <fmt/format.h>

#include <utility>

#include "lanthorn/error.h"
#include "render/record.h"

namespace lanthorn {

namespace {

constexpr auto poll_interval = std::chrono::milliseconds(1);

}  // namespace

TeamMember::TeamMember(Team& team, const StopRule& stop, const RenderState& state, Clock::time_point start)
    : team_(team),
      first_round_(team.rounds),
      stop_(stop),
      start_(start),
      early_(std::exchange(team.early, {})),
      gathering_(team.link.rank, team.link.size),
      tree_check_(team.link.size, gathering_.awaited_children()),
      round_(team.rounds),
      identity_(state.record.identity) {
  if (is_first())
    deal_.emplace(stop, team, state.passes);
  else
    questions_.push_back({.kind = MessageKind::join,
                          .a = static_cast<std::uint64_t>(Gathering::parent(team.link.rank)),
                          .b = static_cast<std::uint64_t>(gathering_.awaited_children()),
                          .rest = bytes_of(settings_text(state.record))});
  thread_ = std::thread([this] { run(); });
}

TeamMember::~TeamMember() {
  {
    const std::lock_guard lock(mutex_);
    is_abandoned_ = true;
  }
  if (thread_.joinable()) thread_.join();
}

void TeamMember::finish() {
  thread_.join();
  if (problem_) std::rethrow_exception(problem_);
  team_.rounds = (is_first() ? *deal_->last_round() : *last_round_) + 1;
}

void TeamMember::settle(bool enough) {
  const std::lock_guard lock(mutex_);
  deal_->settle(enough);
}

void TeamMember::stop() {
  const std::lock_guard lock(mutex_);
  deal_->stop();
}

RenderStatistics TeamMember::counts_of_others() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

TeamMember::Task TeamMember::next(RenderState& own, const RenderStatistics& rendered) {
  std::unique_lock lock(mutex_);
  if (!is_first()) questions_.push_back({.kind = MessageKind::ask, .rest = encode_counts(rendered)});
  for (;;) {
    if (problem_) std::rethrow_exception(problem_);
    if (auto task = is_first() ? try_first(own) : try_other(own)) return *std::move(task);
    changed_.wait_for(lock, poll_interval);
  }
}

std::optional<TeamMember::Task> TeamMember::try_first(RenderState& own) {
  if (!gathered_.empty()) {
    Sums sums{std::move(gathered_.front())};
    gathered_.pop_front();
    return sums;
  }
  const Deal::Dealt dealt = deal_->next(seconds());
  if (dealt.answer == Deal::Answer::pass) {
    hand_over(own, dealt.round);
    return Pass{dealt.pass};
  }
  if (dealt.answer == Deal::Answer::wait) {
    hand_over(own, dealt.round + 1);
    return std::nullopt;
  }
  hand_over(own, *deal_->last_round() + 1);
  return deal_->is_settled() ? std::optional<Task>(End{}) : std::nullopt;
}

std::optional<TeamMember::Task> TeamMember::try_other(RenderState& own) {
  if (!answer_) return std::nullopt;
  const Message answer = *std::exchange(answer_, std::nullopt);
  if (answer.kind == MessageKind::deal) {
    hand_over(own, answer.b);
    return Pass{answer.a};
  }
  hand_over(own, answer.a + 1);
  if (answer.kind == MessageKind::wait) return std::nullopt;
  last_round_ = answer.a;
  is_handed_over_ = true;
  return End{};
}

// Hands the sums of all rounds before `end` over to the thread.
void TeamMember::hand_over(RenderState& own, std::uint64_t end) {
  for (; round_ < end; ++round_) {
    RoundSums sums;
    if (!own.passes.empty()) sums = std::exchange(own, empty_like(own));
    arriving_.emplace_back(round_, std::move(sums));
  }
}

void TeamMember::run() try {
  while (!is_over())
    if (!step()) std::this_thread::sleep_for(poll_interval);
} catch (...) {
  const std::lock_guard lock(mutex_);
  problem_ = std::current_exception();
  changed_.notify_all();
}

bool TeamMember::is_over() {
  const bool all_sent = team_.link.all_sent();
  const std::lock_guard lock(mutex_);
  if (problem_ || is_abandoned_) return true;
  if (!all_sent || !gathering_.is_empty() || !arriving_.empty()) return false;
  if (!is_first()) return is_handed_over_;
  return deal_->is_settled() && static_cast<int>(ended_.size()) == team_.link.size - 1;
}

bool TeamMember::step() {
  std::vector<Message> questions;
  {
    const std::lock_guard lock(mutex_);
    questions.swap(questions_);
  }
  for (const Message& question : questions) send(0, question);
  const auto received = receive();
  if (received) handle(*received);
  add_arrived();
  pass_on();
  if (is_first()) serve();
  return received.has_value();
}

std::optional<TeamMessage> TeamMember::receive() {
  if (early_.empty()) return team_.link.receive();
  TeamMessage message = std::move(early_.front());
  early_.pop_front();
  return message;
}

void TeamMember::handle(const TeamMessage& received) {
  Message message = decode_message(received.bytes);
  if (message.first_round > first_round_) {
    team_.early.push_back(received);
    return;
  }
  if (message.kind == MessageKind::sums) {
    PackedSums sums{std::move(message.rest), fmt::format("the sums of process {}", received.from)};
    return gathering_.add_child(message.a, std::move(sums));
  }
  const std::lock_guard lock(mutex_);
  if (is_first()) return handle_at_first(received.from, message);
  if (message.kind == MessageKind::give_up) {
    give_up_ = true;
    if (message.a != 0) discard_ = true;
    return;
  }
  answer_ = std::move(message);
  changed_.notify_all();
}

void TeamMember::handle_at_first(int from, const Message& message) {
  if (message.kind == MessageKind::failed)
    throw Error(fmt::format("process {} of {}: {}", from, team_.link.size, text_of(message.rest)));
  if (message.kind == MessageKind::join) {
    const std::string sender = fmt::format("process {} of {}", from, team_.link.size);
    const RenderRecord record = read_record(text_of(message.rest), sender);
    if (const auto difference = identity_difference(identity_, record.identity))
      throw Error(fmt::format("{} renders something else: it differs in {}", sender, *difference));
    return tree_check_.join(from, message.a, message.b);
  }
  add_counts(counts_, message.rest);
  waiting_.insert(from);
}

void TeamMember::add_arrived() {
  std::deque<std::pair<std::uint64_t, RoundSums>> arrived;
  {
    const std::lock_guard lock(mutex_);
    arrived.swap(arriving_);
  }
  for (auto& [round, sums] : arrived) gathering_.add_own(round, std::move(sums));
}

void TeamMember::pass_on() {
  while (auto complete = gathering_.take_complete()) {
    if (is_first()) {
      RoundSums sums = complete->take_sums();
      const std::lock_guard lock(mutex_);
      gathered_.push_back(std::move(sums));
      changed_.notify_all();
    } else {
      send(Gathering::parent(team_.link.rank),
           {.kind = MessageKind::sums, .a = complete->round, .rest = complete->take_bytes()});
    }
  }
}

// Answers questions, and tells the other processes when their passes are not needed any more.
void TeamMember::serve() {
  const std::lock_guard lock(mutex_);
  while (!waiting_.empty()) {
    const int rank = *waiting_.begin();
    const Deal::Dealt dealt = deal_->next(seconds());
    if (dealt.answer == Deal::Answer::wait) {
      tell_to_wait(dealt.round);
      break;
    }
    if (dealt.answer == Deal::Answer::pass) {
      send(rank, {MessageKind::deal, dealt.pass, dealt.round});
    } else {
      send(rank, {MessageKind::end, *deal_->last_round()});
      ended_.insert(rank);
    }
    waiting_.erase(rank);
  }
  tell_to_give_up();
}

void TeamMember::tell_to_wait(std::uint64_t round) {
  for (const int rank : waiting_) {
    const auto told = told_to_wait_.find(rank);
    if (told != told_to_wait_.end() && told->second == round) continue;
    told_to_wait_[rank] = round;
    send(rank, {MessageKind::wait, round});
  }
}

void TeamMember::tell_to_give_up() {
  const bool is_dropped = stop_.drop && stop_.drop->load(), is_enough = deal_->is_settled();
  if (!(is_dropped || is_enough) || std::exchange(has_told_to_give_up_, true)) return;
  for (int rank = 1; rank < team_.link.size; ++rank)
    if (!ended_.contains(rank)) send(rank, {MessageKind::give_up, is_enough ? 1u : 0u});
}

void report_failure(const TeamLink& link, const std::string& message) {
  link.send(0, encode({.kind = MessageKind::failed, .rest = bytes_of(message)}));
  while (!link.all_sent()) std::this_thread::sleep_for(poll_interval);
}

}  // namespace lanthorn
