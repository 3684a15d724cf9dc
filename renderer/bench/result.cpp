#include "bench/result.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace lucerna::bench {
namespace {

using Json = nlohmann::ordered_json;

/// Writes and reads with one list of fields, so that the two cannot differ.
struct Writer {
  Json json = Json::object();
  void operator()(const char* key, const std::string& x) { json[key] = x; }
  void operator()(const char* key, const double& x) { json[key] = x; }
  void operator()(const char* key, const bool& x) { json[key] = x; }
  void operator()(const char* key, const int& x) { json[key] = x; }
  void operator()(const char* key, const uint32_t& x) { json[key] = x; }
  void operator()(const char* key, const uint64_t& x) { json[key] = x; }
  void operator()(const char* key, const Layers& x) {
    for (size_t k = 0; k < x.size(); ++k) json[key][stats::k_layer_names[k]] = x[k];
  }
  void operator()(const char* key, const stats::Band& x) { json[key] = {x.low, x.middle, x.high}; }
  template <class T>
  void later(const char* key, const T& x) {
    (*this)(key, x);
  }
};

struct Reader {
  const Json& json;
  std::string where;

  const Json& at(const char* key) const {
    if (!json.is_object() || !json.contains(key)) throw_error(where, "'{}' is missing", key);
    return json.at(key);
  }
  double number(const char* key, const Json& j) const {
    const double x = j.is_number() ? j.get<double>() : NAN;
    if (!std::isfinite(x) || x < 0) throw_error(where, "'{}': expected a number from 0 on", key);
    return x;
  }
  void operator()(const char* key, std::string& x) const {
    if (!at(key).is_string()) throw_error(where, "'{}': expected a text", key);
    x = at(key).get<std::string>();
  }
  void operator()(const char* key, bool& x) const {
    if (!at(key).is_boolean()) throw_error(where, "'{}': expected true or false", key);
    x = at(key).get<bool>();
  }
  void operator()(const char* key, double& x) const { x = number(key, at(key)); }
  void operator()(const char* key, int& x) const { x = int(number(key, at(key))); }
  void operator()(const char* key, uint32_t& x) const { x = uint32_t(number(key, at(key))); }
  void operator()(const char* key, uint64_t& x) const { x = uint64_t(number(key, at(key))); }
  void operator()(const char* key, Layers& x) const {
    const Reader layers{at(key), where + ": " + key};
    for (size_t k = 0; k < x.size(); ++k) layers(stats::k_layer_names[k], x[k]);
  }
  void operator()(const char* key, stats::Band& x) const {
    const Json& list = at(key);
    if (!list.is_array() || list.size() != 3) throw_error(where, "'{}': expected three numbers", key);
    x = {number(key, list[0]), number(key, list[1]), number(key, list[2])};
  }
  /// Defaults for older files.
  template <class T>
  void later(const char* key, T& x) const {
    if (json.contains(key)) (*this)(key, x);
  }
};

template <class V, class P>
void visit_point(V& v, P& p) {
  v("wall_s", p.wall_s), v("device_s", p.device_s), v("rays", p.rays), v("samples", p.samples);
  v("estimated", p.estimated), v("true", p.truth), v("tiles", p.tiles), v.later("relmse", p.relmse),
      v.later("seen", p.seen);
}

template <class V, class R>
void visit_result(V& v, R& r) {
  v("scene", r.scene), v("setting", r.setting), v("budget", r.budget), v("repeat", r.repeat);
  v("seed", r.seed), v("scene_hash", r.scene_hash), v("reference_hash", r.reference_hash);
  v("tracer", r.tracer), v("wall_s", r.wall_s), v("device_s", r.device_s), v("setup_s", r.setup_s);
  v("rays", r.rays), v("paths", r.paths), v("samples", r.samples);
  v("estimated", r.estimated), v("true", r.truth), v("component_s", r.component_s);
  v("mse", r.mse), v("relmse", r.relmse), v.later("relmse_all", r.relmse_all);
  v.later("seen", r.seen), v.later("seen_all", r.seen_all);
  v("in_reference_noise", r.in_reference_noise);
  v("tiles_median", r.tiles.median), v("tiles_decile", r.tiles.decile), v("tiles_worst", r.tiles.worst);
  v("heavy_tiles", r.tiles.heavy), v("tiles_over", r.tiles.over), v("dropped", r.dropped);
  v.later("records", r.records), v.later("record_rays", r.record_rays);
  v.later("paths_error", r.parts.paths), v.later("records_error", r.parts.records);
  v.later("interpolation_error", r.parts.interpolation);
}

template <class V, class F>
void visit_forecast(V& v, F& f) {
  v("at_s", f.at_s), v("seconds", f.seconds), v("rays", f.rays);
}

}  // namespace

nlohmann::ordered_json to_json(const Result& result) {
  Writer w;
  visit_result(w, result);
  if (result.forecast) {
    Writer f;
    visit_forecast(f, *result.forecast);
    w.json["forecast"] = f.json;
  }
  w.json["curve"] = Json::array();
  for (const CurvePoint& point : result.curve) {
    Writer p;
    visit_point(p, point);
    w.json["curve"].push_back(p.json);
  }
  return w.json;
}

Result result_from_json(const Json& json, const std::string& where) {
  Result result;
  const Reader r{json, where};
  visit_result(r, result);
  if (json.contains("forecast")) {
    const Reader f{json.at("forecast"), where + ": forecast"};
    visit_forecast(f, result.forecast.emplace());
  }
  const Json& curve = r.at("curve");
  if (!curve.is_array() || curve.empty()) throw_error(where, "'curve': expected a list of points");
  for (const Json& point : curve) {
    const Reader p{point, where + ": curve"};
    visit_point(p, result.curve.emplace_back());
    if (result.curve.size() > 1 && !(result.curve.back().wall_s > result.curve.end()[-2].wall_s))
      throw_error(where, "'curve': the seconds do not go forward");
  }
  if (!(result.wall_s > 0) || !(result.samples > 0)) throw_error(where, "nothing was rendered");
  return result;
}

Result parse_result(const std::string& text, const std::string& where) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) throw_error(where, "not JSON, perhaps half a file");
  return result_from_json(json, where);
}

}  // namespace lucerna::bench
