#include "cluster/pictures/player.h"

#include "proto/base/format.h"
#include "proto/base/json.h"

namespace corridor::cluster {
namespace {

constexpr const char* kStyle = R"css(
body { font: 15px/1.4 sans-serif; color: #2d2d33; margin: 24px; max-width: 1280px; }
canvas { width: 100%; border-radius: 4px; background: #fff; touch-action: none; }
button, select { font: inherit; padding: 4px 12px; }
#controls { display: flex; gap: 10px; align-items: center; margin: 12px 0; flex-wrap: wrap; }
#time { flex: 1; min-width: 200px; }
#clock { font-variant-numeric: tabular-nums; min-width: 5em; text-align: right; }
#values { display: flex; gap: 48px; flex-wrap: wrap; align-items: flex-start; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
td, th { padding: 2px 10px; text-align: right; font-weight: normal; }
td.chosen { outline: 2px solid #dc5f00; }
p { color: #77777d; }
)css";

// Clips as `to_json` writes them: vehicles are [id, s, d, speed, length, width, yaw].
constexpr const char* kScript = R"js(
const $ = id => document.getElementById(id);
const canvas = $('road'), pen = canvas.getContext('2d');
const commands = ['keep', 'left', 'right'];
let clip, time = 0, playing = false, span = 100, last;

const lerp = (a, b, share) => a + (b - a) * share;
const duration = () => clip.step_s * (clip.steps.length - 1);
const stepAt = t => clip.steps[Math.min(clip.steps.length - 1, Math.floor(t / clip.step_s + 1e-9))];

function sceneAt(t) {
  const at = Math.min(t / clip.step_s, clip.steps.length - 1), i = Math.floor(at + 1e-9);
  if (i + 1 >= clip.steps.length) return clip.steps[i];
  const scenes = [clip.steps[i], ...clip.steps[i].on_the_way, clip.steps[i + 1]];
  const place = Math.max(0, at - i) * (scenes.length - 1);
  const k = Math.min(Math.floor(place), scenes.length - 2), share = place - k;
  const between = (a, b) => a.map((value, j) => j === 0 ? value : lerp(value, b[j], share));
  const later = new Map(scenes[k + 1].others.map(other => [other[0], other]));
  return {
    ego: between(scenes[k].ego, scenes[k + 1].ego),
    others: scenes[k].others.filter(o => later.has(o[0])).map(o => between(o, later.get(o[0]))),
  };
}

function drawRoad(scene, step) {
  const width = canvas.clientWidth, ratio = window.devicePixelRatio || 1, scale = width / span;
  const road = clip.lanes * clip.lane_width_m, height = road * scale + 20;
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  canvas.style.height = height + 'px';
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  const behind = 0.35 * span, x = s => (s - scene.ego[1] + behind) * scale;
  const y = d => 10 + (road - d) * scale;
  pen.fillStyle = '#ededf0';
  pen.fillRect(0, 10, width, road * scale);
  const decision = step.decision;
  if (decision) {
    const w = road / decision.front_gaps_m.length;
    decision.window_open.forEach((open, i) => {
      const corridor = decision.window_first + i;
      if (!open || corridor < 0 || corridor >= decision.front_gaps_m.length) return;
      const from = step.ego[1] - step.ego[4] - decision.back_gaps_m[corridor];
      const to = step.ego[1] + decision.front_gaps_m[corridor];
      pen.fillStyle = corridor === decision.corridor ? '#fdd591' : '#c4dff5';
      pen.fillRect(x(from), y((corridor + 1) * w) + 1, (to - from) * scale, w * scale - 2);
    });
  }
  pen.strokeStyle = '#b8b8bf';
  for (let lane = 0; lane <= clip.lanes; ++lane) {
    pen.lineWidth = lane % clip.lanes ? 2 : 3;
    pen.setLineDash(lane % clip.lanes ? [3 * scale, 6 * scale] : []);
    pen.lineDashOffset = (scene.ego[1] - behind) * scale;
    pen.beginPath();
    pen.moveTo(0, y(lane * clip.lane_width_m));
    pen.lineTo(width, y(lane * clip.lane_width_m));
    pen.stroke();
  }
  pen.setLineDash([]);
  if (decision) {
    pen.strokeStyle = '#dc5f00';
    pen.lineWidth = 2.5;
    pen.beginPath();
    decision.path_s_m.forEach((s, i) => pen.lineTo(x(s), y(decision.path_d_m[i])));
    pen.stroke();
  }
  const atEnd = time >= duration() - 1e-9;
  const draw = (vehicle, colour) => {
    const [, s, d, speed, long, wide, yaw] = vehicle;
    pen.save();
    pen.translate(x(s), y(d));
    pen.rotate(-yaw);
    pen.fillStyle = colour;
    pen.beginPath();
    pen.roundRect(-long * scale, -wide * scale / 2, long * scale, wide * scale, 0.2 * wide * scale);
    pen.fill();
    pen.fillStyle = '#fff';
    pen.textAlign = 'center';
    pen.textBaseline = 'middle';
    pen.font = `${Math.min(14, 0.7 * wide * scale)}px sans-serif`;
    pen.fillText(Math.round(3.6 * speed), -long * scale / 2, 0);
    pen.restore();
  };
  for (const other of scene.others) {
    draw(other, atEnd && clip.collision && clip.collision.other === other[0] ? '#cc2620' : '#858a94');
  }
  draw(scene.ego, '#0059b5');
}

function showValues(step, scene) {
  const decision = step.decision;
  let text = `${Math.round(3.6 * scene.ego[3])} km/h`;
  if (step.command !== undefined) text += `, BP asks for ${commands[step.command]}`;
  if (decision) {
    text += `, set-point ${Math.round(3.6 * decision.set_point_mps)} km/h; reward of this step: BP ` +
        `${decision.bp_reward.toFixed(2)}, MoP ${decision.mop_reward.toFixed(2)}`;
  }
  if (clip.collision && time >= duration() - 1e-9) text += `; collision (${clip.collision.kind})`;
  $('said').textContent = text;
  const cell = (value, chosen) => `<td class="${chosen ? 'chosen' : ''}">${value.toFixed(2)}</td>`;
  let html = '';
  if (decision && decision.bp_values.length) {
    html += '<table><tr><th>BP</th><th>value</th></tr>' + decision.bp_values.map((value, i) =>
        `<tr><th>${commands[i]}</th>${cell(value, i === step.command)}</tr>`).join('') + '</table>';
  }
  if (decision && decision.mop_values.length) {
    html += '<table><tr><th>MoP</th><th>left</th><th>straight</th><th>right</th></tr>';
    for (let row = decision.mop_values.length / 3 - 1; row >= 0; --row) {
      html += `<tr><th>${clip.speed_changes_mps[row] > 0 ? '+' : ''}${clip.speed_changes_mps[row]} m/s</th>` + [2, 1, 0].map(i =>
          cell(decision.mop_values[3 * row + i], 3 * row + i === decision.mop_action)).join('') + '</tr>';
    }
    html += '</table>';
  }
  $('values').innerHTML = html;
}

function show() {
  const scene = sceneAt(time), step = stepAt(time);
  drawRoad(scene, step);
  showValues(step, scene);
  $('time').value = time;
  $('clock').textContent = (clip.start_s + time).toFixed(1) + ' s';
  $('play').textContent = playing ? 'Pause' : 'Play';
}
function seek(t) { time = Math.max(0, Math.min(duration(), t)); show(); }
function tick(now) {
  if (playing) {
    time += (now - last) / 1000 * $('rate').value;
    if (time >= duration()) { time = duration(); playing = false; }
    show();
  }
  last = now;
  requestAnimationFrame(tick);
}
function choose(i) {
  clip = clips[i];
  $('title').textContent = clip.title;
  $('time').max = duration();
  seek(0);
}
function toggle() {
  if (!playing && time >= duration()) time = 0;
  playing = !playing;
  show();
}
clips.forEach((c, i) => $('clip').add(new Option(c.title, i)));
$('clip').hidden = clips.length < 2;
$('clip').onchange = event => choose(event.target.value);
$('play').onclick = toggle;
$('back').onclick = () => { playing = false; seek((Math.ceil(time / clip.step_s - 1e-6) - 1) * clip.step_s); };
$('on').onclick = () => { playing = false; seek((Math.floor(time / clip.step_s + 1e-6) + 1) * clip.step_s); };
$('time').oninput = event => { playing = false; seek(+event.target.value); };
const zoom = factor => { span = Math.max(20, Math.min(250, span * factor)); show(); };
$('nearer').onclick = () => zoom(0.8);
$('farther').onclick = () => zoom(1.25);
canvas.onwheel = event => { event.preventDefault(); zoom(event.deltaY > 0 ? 1.1 : 0.9); };
document.onkeydown = event => {
  if (event.target.tagName === 'SELECT') return;
  if (event.key === ' ') { event.preventDefault(); toggle(); }
  if (event.key === 'ArrowLeft') $('back').click();
  if (event.key === 'ArrowRight') $('on').click();
};
window.onresize = show;
choose(0);
requestAnimationFrame(tick);
)js";

constexpr const char* kBody = R"html(
<h2 id="title"></h2>
<canvas id="road"></canvas>
<div id="controls">
<button id="play">Play</button><button id="back">Step back</button><button id="on">Step on</button>
<input id="time" type="range" min="0" step="0.05"><span id="clock"></span>
<select id="rate"><option value="0.25">x 1/4</option><option value="1" selected>x 1</option>
<option value="4">x 4</option></select>
<button id="nearer">Nearer</button><button id="farther">Farther</button>
<select id="clip"></select>
</div>
<div id="said"></div>
<div id="values"></div>
<p>Numbers on vehicles are km/h. Blue: corridors that the motion planner was shown as open, as far as they are free; yellow: the one it
chose; line: its trajectory. Space plays, arrows step, the wheel zooms.</p>
)html";

}  // namespace

std::string player_page(const std::vector<Clip>& clips) {
  Json list = Json::array();
  for (const Clip& clip : clips) {
    Json object = to_json(clip.trace);
    object["title"] = clip.title;
    object["start_s"] = clip.start_s;
    object["speed_changes_mps"] = clip.speed_changes_mps;
    list.push_back(std::move(object));
  }
  std::string data = list.dump();
  // No text of it may end the script.
  for (std::size_t at = 0; (at = data.find('<', at)) != std::string::npos; at += 6)
    data.replace(at, 1, "\\u003c");
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>corridor</title>"
      "<style>{}</style></head><body>{}<script>\nconst clips = {};\n{}</script></body></html>\n",
      kStyle, kBody, data, kScript);
}

}  // namespace corridor::cluster
