// The page: asks widget.c for every number, and draws.
'use strict';
const at = id => document.getElementById(id);
const colours = { mean: '#2166ac', spread: '#e08214', drift: '#1b7837', slope: '#b2182b' };
let C, names = [];

const sums = (k, h) => {
  const p = C._widget_sums(k, h);
  return p ? Array.from(C.HEAPF64.subarray(p >> 3, (p >> 3) + 7)) : null;
};
const array = (p, n) => C.HEAPF64.subarray(p >> 3, (p >> 3) + n);
const percent = v => (100 * v).toPrecision(2) + ' %';

function colour(t) { // from blue over white to red
  t = Math.max(-1, Math.min(1, t));
  const fade = Math.round(255 * (1 - Math.abs(t)));
  return t < 0 ? `rgb(${fade},${Math.round(102 + 153 * (1 + t))},255)` : `rgb(255,${fade},${fade})`;
}

function drawPatch(k, n, dim, h) {
  const canvas = at('patch'), g = canvas.getContext('2d'), size = canvas.width;
  const x = array(C._widget_position(0), n), y = array(C._widget_position(1), n);
  const z = dim === 3 ? array(C._widget_position(2), n) : null, density = array(C._widget_density(), n);
  const side = dim === 3 ? 13 : 48, view = dim === 3 ? 13 : 16, low = (side - view) / 2, scale = size / view;
  const seen = i => !z || Math.abs(z[i] - side / 2) <= 0.5;
  let centre = -1, least = Infinity;
  g.clearRect(0, 0, size, size);
  for (let i = 0; i < n; i++) {
    if (!seen(i)) continue;
    const away = Math.hypot(x[i] - side / 2, y[i] - side / 2);
    if (away < least) least = away, centre = i;
    g.fillStyle = density[i] ? colour((density[i] - 1) / 0.1) : '#ddd';
    g.strokeStyle = '#777';
    g.beginPath();
    g.arc((x[i] - low) * scale, size - (y[i] - low) * scale, 0.3 * scale, 0, 2 * Math.PI);
    g.fill(), g.stroke();
  }
  g.strokeStyle = '#222', g.lineWidth = 2;
  for (const radius of [h, C._widget_support(k) * h]) {
    g.beginPath();
    g.arc((x[centre] - low) * scale, size - (y[centre] - low) * scale, radius * scale, 0, 2 * Math.PI);
    g.stroke();
  }
  g.lineWidth = 1;
  const distances = [];
  for (let j = 0; j < n; j++) {
    const r = Math.hypot(x[j] - x[centre], y[j] - y[centre], z ? z[j] - z[centre] : 0);
    if (r < C._widget_support(k) * h) distances.push(r / h);
  }
  return distances;
}

// A frame with numbers; returns the map of a point.
function axes(canvas, x0, x1, y0, y1, label, logarithmic) {
  const g = canvas.getContext('2d'), w = canvas.width, m = 70;
  const f = logarithmic ? Math.log10 : v => v;
  const X = x => m + (x - x0) / (x1 - x0) * (w - m - 20), Y = y => w - m - (f(y) - f(y0)) / (f(y1) - f(y0)) * (w - m - 20);
  g.clearRect(0, 0, w, w);
  g.fillStyle = '#222', g.strokeStyle = '#999', g.font = '20px system-ui, sans-serif';
  g.strokeRect(m, 20, w - m - 20, w - m - 20);
  g.textAlign = 'center';
  for (let i = 0; i <= 4; i++) {
    const x = x0 + (x1 - x0) * i / 4;
    g.fillText(+x.toPrecision(3), X(x), w - m + 26);
  }
  g.fillText(label, w / 2, w - 12);
  g.textAlign = 'right';
  const ticks = logarithmic ? [1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1].filter(y => y >= y0 && y <= y1) : [0, 1, 2, 3, 4].map(i => y0 + (y1 - y0) * i / 4);
  for (const y of ticks) g.fillText(logarithmic ? y.toExponential(0) : +y.toPrecision(2), m - 6, Y(y) + 6);
  return { g, X, Y, clamp: y => Y(Math.max(y0, Math.min(y1, y))) };
}

function drawCurve(k, dim, distances) {
  const kappa = C._widget_support(k), top = C._widget_w(k, dim, 1e-9) * 1.05;
  const { g, X, Y } = axes(at('curve'), 0, kappa, 0, top, 'r/h');
  g.strokeStyle = colours.mean, g.lineWidth = 3;
  g.beginPath();
  for (let i = 0; i <= 200; i++) g.lineTo(X(kappa * i / 200), Y(C._widget_w(k, dim, kappa * (i + 1e-9) / 200)));
  g.stroke();
  g.lineWidth = 1, g.fillStyle = colours.slope;
  for (const q of distances) {
    g.beginPath();
    g.arc(X(q), Y(C._widget_w(k, dim, q)), 5, 0, 2 * Math.PI);
    g.fill();
  }
}

function drawScan(k, dim, h) {
  const first = 0.6, last = 3, points = dim === 3 ? 25 : 49, rows = [];
  for (let i = 0; i < points; i++) {
    const at = first + (last - first) * i / (points - 1), s = sums(k, at);
    if (s) rows.push([at, Math.abs(s[0]), s[1], s[2], s[3]]);
  }
  const { g, X, clamp } = axes(at('scan'), first, last, 1e-5, 1, 'h/Δx', true);
  g.fillStyle = 'rgba(80,140,80,.15)';
  g.fillRect(X(C._widget_low(k)), 20, X(C._widget_high(k)) - X(C._widget_low(k)), at('scan').height - 90);
  [colours.mean, colours.spread, colours.drift, colours.slope].forEach((c, column) => {
    g.strokeStyle = c, g.lineWidth = 3;
    g.beginPath();
    for (const row of rows) g.lineTo(X(row[0]), clamp(row[column + 1]));
    g.stroke();
  });
  g.strokeStyle = '#222', g.lineWidth = 1;
  g.beginPath(), g.moveTo(X(h), 20), g.lineTo(X(h), at('scan').height - 70), g.stroke();
}

function facts(k, dim, h, dx, s) {
  const pairing = C._widget_pairing(k), resolution = C._widget_deviation(k) * h * dx;
  const rows = [
    ['smoothing length h', (h * dx).toPrecision(3) + ' mm', 'support radius ' + (C._widget_support(k) * h * dx).toPrecision(3) + ' mm'],
    ['neighbours', s[4].toFixed(1), 'mean; least distance ' + (s[5] * dx).toPrecision(2) + ' mm'],
    ['density estimate', (s[0] < 0 ? '−' : '+') + percent(Math.abs(s[0])) + ' ± ' + percent(s[1]), 'Σ V W − 1: mean and spread'],
    ['gradients', percent(s[2]) + '; ' + percent(s[3]), 'h |Σ V ∇W|, which should be 0; the slope of a line, both rms'],
    ['pairing', pairing < 0 ? pairing.toExponential(0) : 'no',
      pairing < 0 ? 'the Fourier transform falls below 0: with many neighbours particles clump' : 'the Fourier transform is nowhere negative'],
    ['resolution σ', resolution.toPrecision(3) + ' mm', 'the standard deviation of W: what is smaller is smoothed away'],
    ['cost', s[6].toFixed(0), 'pairs of a right-hand side a particle, in those of Wendland C2'],
  ];
  at('facts').innerHTML = rows.map(r => `<tr><td>${r[0]}<td>${r[1]}<td>${r[2]}`).join('');
}

function verdict(k, dim, h) {
  const low = C._widget_low(k), high = C._widget_high(k), best = C._widget_best(k), pairs = C._widget_pairing(k) < 0;
  const text = h < low ? `Too small: below ${low} Δx sums have too few neighbours, and disorder decides.`
    : h > high ? `Larger than needed: above ${high} Δx ${pairs ? 'particles pair, and ' : ''}you pay for neighbours that only smooth.`
    : `Sound: ${low} to ${high} Δx are recommended here, ${best} is the default.`;
  at('verdict').textContent = text;
  at('verdict').className = h < low || h > high ? 'warn' : '';
}

function draw() {
  const k = +at('kernel').value, dim = +at('dim').value, h = +at('h').value, dx = +at('dx').value;
  at('hText').textContent = h.toFixed(2), at('dxText').textContent = dx + ' mm';
  at('disorderText').textContent = percent(+at('disorder').value) + ' of Δx';
  const n = C._widget_place(dim, +at('disorder').value, 1);
  drawScan(k, dim, h);
  const s = sums(k, h);
  if (!s) return void (at('verdict').textContent = 'The support is larger than half the box of this page.');
  drawCurve(k, dim, drawPatch(k, n, dim, h));
  facts(k, dim, h, dx, s);
  verdict(k, dim, h);
}

// index.html#test: what main() in widget.c prints.
function test() {
  const lines = [];
  names.forEach((name, k) => {
    for (let d = 1; d <= 3; d++)
      for (let i = 0; i <= 20; i++) lines.push(`w ${name} ${d} ${i * 0.125} ${C._widget_w(k, d, i * 0.125)} ${C._widget_dwdr(k, d, i * 0.125)}`);
  });
  for (const d of [2, 3])
    names.forEach((name, k) => {
      C._widget_place(d, 0.25, 1);
      lines.push(`sums ${name} ${d} ` + sums(k, C._widget_best(k)).join(' '));
    });
  at('test').textContent = lines.join('\n');
}

Kernels().then(module => {
  C = module;
  for (let k = 0, p; (p = C._widget_name(k)); k++) {
    names.push(C.UTF8ToString(p));
    at('kernel').add(new Option(names[k], k));
  }
  for (const id of ['dim', 'dx', 'h', 'disorder']) at(id).addEventListener('input', draw);
  at('kernel').addEventListener('input', () => (at('h').value = C._widget_best(+at('kernel').value), draw()));
  draw();
  if (location.hash === '#test') test();
});
