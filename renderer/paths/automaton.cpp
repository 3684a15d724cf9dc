#include "paths/automaton.h"

#include <algorithm>
#include <bit>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>

namespace lucerna::paths {

const ByComponent<const char*> k_component_names{"primary", "secondary", "tertiary", "caustic"};
const ByComponent<const char*> k_component_expressions{
    "E[SG]*L|E[SG]*DL",
    "E[SG]*D[SG]*DL",
    "E[SG]*D[SG]*D[DSG]+L",
    "E[SG]*D[SG]+L",
};

namespace {

/// The two halves of the last component: directly visible caustics, and those seen by mirrors and glass.
constexpr std::array<const char*, 2> k_caustic_halves{"ED[SG]+L", "E[SG]+D[SG]+L"};

constexpr std::string_view k_letters = "EDGSL";
constexpr std::string_view k_scatter_letters = "DGS";

int letter_index(char c) {
  const size_t at = k_letters.find(c);
  return at == std::string_view::npos ? -1 : static_cast<int>(at);
}

/// Thompson construction: a state has one labelled edge set (mask of letters) or up to two empty edges.
struct NfaState {
  uint32_t mask = 0;
  int to = -1;
  int empty[2] = {-1, -1};
};
struct Nfa {
  std::vector<NfaState> states;
  int add(const NfaState& s = {}) { return states.push_back(s), static_cast<int>(states.size()) - 1; }
};

struct Fragment {
  int start, end;
};  // `end` is a state without edges

class Parser {
 public:
  Parser(const std::string& text, Nfa& nfa) : text_(text), nfa_(nfa) {}

  Fragment parse() {
    const Fragment whole = alternatives();
    if (at_ != text_.size()) fail("expected an operator, a letter or the end");
    return whole;
  }

 private:
  [[noreturn]] void fail(const char* expected) const {
    throw_error(fmt::format("path expression '{}', character {}", text_, at_ + 1), "{}", expected);
  }
  bool done() const { return at_ == text_.size(); }

  Fragment alternatives() {
    Fragment left = sequence();
    while (!done() && text_[at_] == '|') {
      ++at_;
      const Fragment right = sequence();
      const int end = nfa_.add();
      const int start = nfa_.add({0, -1, {left.start, right.start}});
      nfa_.states[left.end].empty[0] = end;
      nfa_.states[right.end].empty[0] = end;
      left = {start, end};
    }
    return left;
  }

  Fragment sequence() {
    const int empty = nfa_.add();
    Fragment all{empty, empty};
    while (!done() && text_[at_] != '|' && text_[at_] != ')') {
      const Fragment next = repeated();
      nfa_.states[all.end].empty[0] = next.start;
      all.end = next.end;
    }
    return all;
  }

  Fragment repeated() {
    Fragment f = atom();
    while (!done() && std::string_view("*+?").find(text_[at_]) != std::string_view::npos) {
      const char op = text_[at_++];
      const int end = nfa_.add();
      const int start = nfa_.add({0, -1, {f.start, op == '+' ? -1 : end}});
      nfa_.states[f.end].empty[0] = end;
      if (op != '?') nfa_.states[f.end].empty[1] = f.start;
      f = {start, end};
    }
    return f;
  }

  Fragment atom() {
    if (done()) fail("expected a letter");
    if (text_[at_] == '(') {
      ++at_;
      const Fragment inner = alternatives();
      if (done() || text_[at_] != ')') fail("expected ')'");
      ++at_;
      return inner;
    }
    uint32_t mask = 0;
    if (text_[at_] == '[') {
      for (++at_; !done() && text_[at_] != ']'; ++at_) {
        if (letter_index(text_[at_]) < 0) fail("expected one of E D G S L");
        mask |= 1u << letter_index(text_[at_]);
      }
      if (done()) fail("expected ']'");
      if (!mask) fail("a class needs a letter");
    } else if (text_[at_] == '.') {
      for (char c : k_scatter_letters) mask |= 1u << letter_index(c);
    } else {
      if (letter_index(text_[at_]) < 0) fail("expected one of E D G S L . [ (");
      mask = 1u << letter_index(text_[at_]);
    }
    ++at_;
    const int end = nfa_.add();
    const int start = nfa_.add({mask, end, {-1, -1}});
    return {start, end};
  }

  const std::string& text_;
  Nfa& nfa_;
  size_t at_ = 0;
};

using Subset = std::set<int>;

void close(const Nfa& nfa, Subset& subset) {
  std::deque<int> work(subset.begin(), subset.end());
  while (!work.empty()) {
    const int s = work.front();
    work.pop_front();
    for (int to : nfa.states[s].empty)
      if (to >= 0 && subset.insert(to).second) work.push_back(to);
  }
}

Subset step(const Nfa& nfa, const Subset& from, char letter) {
  Subset to;
  for (int s : from)
    if (nfa.states[s].mask >> letter_index(letter) & 1u) to.insert(nfa.states[s].to);
  close(nfa, to);
  return to;
}

/// Merges states that no continuation distinguishes (Moore's partition refinement), keeping state 0 first.
Automaton minimize(const Automaton& in) {
  std::vector<int> group(in.states.size());
  for (size_t i = 0; i < in.states.size(); ++i) group[i] = in.states[i].accept;
  for (size_t groups = 0;;) {
    std::map<std::vector<int>, int> signature_group;
    std::vector<int> refined(group.size());
    for (size_t i = 0; i < group.size(); ++i) {
      std::vector<int> signature{group[i]};
      for (uint8_t next : in.states[i].next) signature.push_back(group[next]);
      refined[i] = signature_group.emplace(signature, static_cast<int>(signature_group.size())).first->second;
    }
    group = refined;
    if (signature_group.size() == groups) break;
    groups = signature_group.size();
  }
  std::vector<int> number(group.size(), -1);  // new index of each group, in order of first state
  Automaton out;
  std::vector<size_t> representative;
  for (size_t i = 0; i < group.size(); ++i)
    if (number[group[i]] < 0)
      number[group[i]] = static_cast<int>(representative.size()), representative.push_back(i);
  for (size_t r : representative) {
    Automaton::State s = in.states[r];
    for (auto& next : s.next) next = static_cast<uint8_t>(number[group[next]]);
    out.states.push_back(s);
  }
  return out;
}

void find_reachable(Automaton& automaton) {
  for (bool changed = true; changed;) {
    changed = false;
    for (auto& s : automaton.states) {
      uint8_t all = s.accept == k_no_component ? 0 : static_cast<uint8_t>(1u << s.accept);
      for (uint8_t next : s.next) all |= automaton.states[next].reachable;
      changed |= (all | s.reachable) != s.reachable;
      s.reachable |= all;
    }
  }
}

}  // namespace

uint8_t Automaton::classify(std::string_view word) const {
  if (word.size() < 2 || word.front() != 'E' || word.back() != 'L') return k_no_component;
  uint8_t state = 0;
  for (char c : word.substr(1, word.size() - 2)) {
    const size_t event = k_scatter_letters.find(c);
    if (event == std::string_view::npos) return k_no_component;
    state = states[state].next[event];
  }
  return states[state].accept;
}

Automaton compile(const std::vector<std::string>& expressions) {
  Nfa nfa;
  Subset start;
  std::vector<int> ends;
  for (const std::string& text : expressions) {
    const Fragment f = Parser(text, nfa).parse();
    start.insert(f.start);
    ends.push_back(f.end);
  }
  close(nfa, start);
  std::map<Subset, uint8_t> number;
  std::vector<Subset> subsets;
  std::vector<std::string> witness;  // a word that leads to the state, for messages
  const auto index_of = [&](const Subset& s, const std::string& word) {
    const auto [it, fresh] = number.emplace(s, static_cast<uint8_t>(subsets.size()));
    if (fresh) {
      if (subsets.size() == 255)
        throw Error("path expressions", "need more than 255 states; use simpler ones");
      subsets.push_back(s), witness.push_back(word);
    }
    return it->second;
  };
  Automaton automaton;
  index_of(step(nfa, start, 'E'), "E");
  for (size_t i = 0; i < subsets.size(); ++i) {
    Automaton::State state;
    for (int e = 0; e < k_scatter_events; ++e)
      state.next[e] =
          index_of(step(nfa, Subset(subsets[i]), k_scatter_letters[e]), witness[i] + k_scatter_letters[e]);
    const Subset lit = step(nfa, subsets[i], 'L');
    for (size_t x = 0; x < ends.size(); ++x) {
      if (!lit.count(ends[x])) continue;
      if (state.accept != k_no_component)
        throw_error("path expressions", "'{}' and '{}' both hold the word {}L", expressions[state.accept],
                    expressions[x], witness[i]);
      state.accept = static_cast<uint8_t>(x);
    }
    automaton.states.push_back(state);
  }
  automaton = minimize(automaton);
  find_reachable(automaton);
  return automaton;
}

Automaton compile_components() {
  std::vector<std::string> expressions(k_component_expressions.begin(), k_component_expressions.end() - 1);
  expressions.insert(expressions.end(), k_caustic_halves.begin(), k_caustic_halves.end());
  Automaton automaton = compile(expressions);
  for (Automaton::State& s : automaton.states) {
    if (s.accept == shared::k_component_count) s.accept = k_caustic;
    constexpr uint8_t k_last = 1u << shared::k_component_count;
    if (s.reachable & k_last) s.reachable = uint8_t((s.reachable & ~k_last) | k_last >> 1);
  }
  // Complete when every state accepts: every state is entered by some word E[DGS]*.
  std::vector<std::string> word(automaton.states.size());
  word[0] = "E";
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t i = 0; i < word.size(); ++i)
      for (int e = 0; e < k_scatter_events && !word[i].empty(); ++e)
        if (auto& w = word[automaton.states[i].next[e]]; w.empty())
          w = word[i] + k_scatter_letters[e], changed = true;
  }
  for (size_t i = 0; i < word.size(); ++i)
    if (automaton.states[i].accept == k_no_component)
      throw_error("path components", "the word {}L belongs to no component", word[i]);
  return automaton;
}

namespace {

/// Continuation-passing matcher over the expression's text itself.
class Matcher {
 public:
  Matcher(std::string_view e, std::string_view w) : e_(e), w_(w) {}
  bool run() {
    return alternatives(0, e_.size(), 0, [&](size_t at) { return at == w_.size(); });
  }

 private:
  template <class K>
  bool alternatives(size_t from, size_t to, size_t at, const K& k) {
    int depth = 0;
    size_t start = from;
    for (size_t i = from; i <= to; ++i) {
      if (i == to || (e_[i] == '|' && depth == 0)) {
        if (sequence(start, i, at, k)) return true;
        start = i + 1;
      } else {
        depth += e_[i] == '(' ? 1 : e_[i] == ')' ? -1 : 0;
      }
    }
    return false;
  }

  bool sequence(size_t from, size_t to, size_t at, const std::function<bool(size_t)>& k) {
    if (from == to) return k(at);
    size_t end = from + 1;
    if (e_[from] == '[') end = e_.find(']', from) + 1;
    if (e_[from] == '(') {
      int depth = 1;
      for (; depth; ++end) depth += e_[end] == '(' ? 1 : e_[end] == ')' ? -1 : 0;
    }
    const char op =
        end < to && std::string_view("*+?").find(e_[end]) != std::string_view::npos ? e_[end] : ' ';
    const size_t rest = op == ' ' ? end : end + 1;
    const auto tail = [&](size_t a) { return sequence(rest, to, a, k); };
    const auto once = [&](size_t a, const std::function<bool(size_t)>& then) {
      if (e_[from] == '(') return alternatives(from + 1, end - 1, a, then);
      if (a == w_.size()) return false;
      const std::string_view set = e_[from] == '.' ? k_scatter_letters : e_.substr(from, end - from);
      return set.find(w_[a]) != std::string_view::npos && then(a + 1);
    };
    std::function<bool(size_t, bool)> repeat = [&](size_t a, bool may_stop) {
      if (may_stop && tail(a)) return true;
      return once(a, [&](size_t b) { return b > a && repeat(b, true); });
    };
    switch (op) {
      case '*':
        return repeat(at, true);
      case '+':
        return repeat(at, false);
      case '?':
        return tail(at) || once(at, tail);
      default:
        return once(at, tail);
    }
  }

  std::string_view e_, w_;
};

}  // namespace

bool matches(const std::string& expression, std::string_view word) { return Matcher(expression, word).run(); }

namespace {

/// For each state the components (bits) that lookups provide, there or further on.
std::vector<uint32_t> looked_up_components(const Automaton& automaton, const LookupRoutes& routes) {
  std::vector<uint32_t> here(automaton.states.size(), 0);
  if (routes.component.empty()) return here;
  for (size_t s = 0; s < here.size(); ++s)
    for (const uint8_t c : routes.component[s])
      if (c != k_no_component) here[s] |= 1u << c;
  std::vector<uint32_t> all = here;
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t s = 0; s < all.size(); ++s)
      for (const Event e : {Event::diffuse, Event::glossy, Event::specular}) {
        // Components of a lookup are not looked up again behind it.
        const uint32_t further = all[automaton.after(static_cast<uint8_t>(s), e)];
        const uint32_t more = all[s] | (e == Event::diffuse ? further & ~here[s] : further);
        changed |= more != all[s];
        all[s] = more;
      }
  }
  return all;
}

}  // namespace

std::vector<uint32_t> pack(const Automaton& automaton, uint32_t enabled, const LookupRoutes& routes,
                           bool met) {
  std::vector<uint32_t> packed;
  const std::vector<uint32_t> looked_up = looked_up_components(automaton, routes);
  // States without a D so far: reached from the eye by G and S alone.
  std::set<uint8_t> mirrors{0};
  for (bool changed = true; changed;) {
    changed = false;
    for (uint8_t s : std::set<uint8_t>(mirrors))
      for (Event e : {Event::glossy, Event::specular})
        changed |= mirrors.insert(automaton.after(s, e)).second;
  }
  // Components of light met in a state, or in states that it leads to.
  std::vector<uint32_t> here(automaton.states.size(), 0);
  for (size_t i = 0; i < here.size(); ++i) {
    const uint8_t accept = automaton.states[i].accept;
    const bool replaced = i < routes.replaced.size() && routes.replaced[i] != 0;
    if (accept != k_no_component && !replaced) here[i] = enabled & 1u << accept;
  }
  std::vector<uint32_t> further = here;
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t i = 0; i < further.size(); ++i) {
      uint32_t all = further[i];
      for (const uint8_t next : automaton.states[i].next) all |= further[next];
      changed |= all != further[i];
      further[i] = all;
    }
  }
  for (size_t i = 0; i < automaton.states.size(); ++i) {
    const auto& s = automaton.states[i];
    const uint32_t component = here[i] != 0 ? s.accept : shared::k_component_none;
    uint32_t further_on = (met ? further[i] : 0) | looked_up[i];
    for (const uint8_t next : s.next) further_on |= further[next];
    packed.push_back(s.next[0] | s.next[1] << 8 | s.next[2] << 16 | component << 24 |
                     (further_on ? 1u << 27 : 0u) | (mirrors.count(static_cast<uint8_t>(i)) ? 1u << 28 : 0u) |
                     (further_on ? static_cast<uint32_t>(std::countr_zero(further_on)) : 0u) << 29);
  }
  for (size_t i = 0; i < packed.size(); ++i) {
    const uint32_t behind = packed[packed[i] & 0xffu];
    const bool nothing = (behind >> 27 & 1u) == 0 && !shared::is_component(behind >> 24 & 7u);
    if (nothing && looked_up[i] == 0) packed[i] |= shared::k_ends_on_diffuse;
  }
  return packed;
}

namespace {

/// lookup_routes(); `onward`: also behind lookups, for paths that have passed one.
LookupRoutes routes_of(const Automaton& automaton, uint32_t enabled, uint32_t cached, bool direct,
                       bool onward) {
  cached &= enabled;
  // Words of the secondary component continue as words of the tertiary one, and nothing is traced behind a
  // lookup.
  if (cached & k_secondary_bit) cached |= enabled & k_tertiary_bit;
  LookupRoutes routes;
  routes.traced = enabled & (~cached | k_primary_bit);
  routes.component.assign(automaton.states.size(),
                          {k_no_component, k_no_component, k_no_component, k_no_component});
  std::set<uint8_t> open{0}, seen{0};  // states that a path can be in before it has been looked up
  while (!open.empty()) {
    const uint8_t state = *open.begin();
    open.erase(open.begin());
    const uint8_t d = automaton.after(state, Event::diffuse), dd = automaton.after(d, Event::diffuse);
    const std::array<uint8_t, k_part_count> component_of{
        automaton.states[d].accept, automaton.states[dd].accept,
        automaton.states[automaton.after(dd, Event::diffuse)].accept,
        automaton.states[automaton.after(d, Event::specular)].accept};
    const auto within = [](uint8_t component, uint32_t set) {
      return component != k_no_component && (set >> component & 1u) != 0;
    };
    const bool traced_on = (within(component_of[1], enabled) && !within(component_of[1], cached)) ||
                           (within(component_of[2], enabled) && !within(component_of[2], cached));
    const bool any = within(component_of[1], cached) || within(component_of[2], cached) ||
                     (direct && component_of[0] == k_primary && (cached & k_primary_bit) != 0);
    const bool looks = any && !traced_on;
    for (uint32_t p = 1; looks && p < k_part_count; ++p)
      if (within(component_of[p], cached))
        routes.component[state][p] = component_of[p], routes.parts |= 1u << p;
    if (direct && looks && within(component_of[0], enabled))
      routes.component[state][0] = component_of[0], routes.parts |= 1u;
    for (const Event e : {Event::diffuse, Event::glossy, Event::specular}) {
      if (e == Event::diffuse && looks && !onward) continue;
      const uint8_t next = automaton.after(state, e);
      if (seen.insert(next).second) open.insert(next);
    }
  }
  return routes;
}

}  // namespace

LookupRoutes lookup_routes(const Automaton& automaton, uint32_t enabled, uint32_t cached, bool direct) {
  return routes_of(automaton, enabled, cached, direct, false);
}

LookupRoutes record_routes(const Automaton& automaton, uint32_t parts, bool recursive, bool caustics) {
  if (!recursive || (parts & k_tertiary_bit) == 0) return {.component = {}, .parts = parts, .traced = parts};
  // Behind ED the components are the parts, so that the rays' own routes are those of a picture of them.
  const uint32_t gathered = parts | k_secondary_bit | (caustics ? k_caustic_bit : 0);
  LookupRoutes own = lookup_routes(automaton, gathered, k_tertiary_bit, (parts & 1u) != 0);
  own.parts = gathered;
  if (!caustics)
    for (auto& component : own.component) component[3] = k_no_component;
  return own;
}

LookupRoutes gather_routes(const Automaton& automaton, uint32_t enabled, const LookupRoutes& own) {
  if (own.component.empty()) return {};
  LookupRoutes routes = routes_of(automaton, enabled, k_tertiary_bit, (own.parts & 1u) != 0, true);
  // Parts that records do not gather there are not there.
  for (auto& component : routes.component)
    for (uint32_t p = 0; p < k_part_count; ++p)
      if ((own.parts >> p & 1u) == 0) component[p] = k_no_component;
  return routes;
}

}  // namespace lucerna::paths
