# Impacts and the two discs by different contact laws: peak force and overlap, duration, restitution, from particles.csv. The
# runs of impact.yaml are also compared with an integration of their law, which shares nothing with the program. A row of
# particles.csv lacks half a sub-step of force at the first touch: up to 1 % of the largest force with damping.

# As in case.yaml and impact.yaml.
function constants() {
  radius = 10
  density = 1.01
  stiffness = 0.25
  alpha = 0.3
}

# Half of a lens: angle t from the line of centres to the end of the chord.
function half_angle(overlap,    c) {
  c = 1 - overlap / (2 * radius)
  return atan2(sqrt(1 - c * c), c)
}

# Spring force of two equal discs.
function spring(law, overlap,    t) {
  if (overlap <= 0) return 0
  if (law == "linear") return alpha * stiffness * 2 * radius * sin(half_angle(0.01 * radius)) * overlap
  if (law == "hertz") return alpha * stiffness * 4 / 3 * sqrt(radius) * overlap ^ 1.5
  t = half_angle(overlap)
  return alpha * stiffness * radius * radius * (2 * t - sin(2 * t))
}

function force(law, eta, overlap, speed) { return spring(law, overlap) + eta * speed }

# Runge-Kutta of fourth order from the first touch until the force is 0: expected["force"], largest mean over a step,
# and expected["overlap"], ["duration"], ["restitution"].
function integrate(law, damping, speed,    mass, eta, h, n, x, v, a, b, c, d, before) {
  mass = density * atan2(0, -1) * radius * radius / 2 # reduced
  eta = 2 * damping * sqrt(stiffness * mass)
  h = 1 / 64
  x = expected["force"] = expected["overlap"] = 0
  v = before = speed
  for (n = 0; n == 0 || force(law, eta, x, v) > 0; ) {
    a = force(law, eta, x, v) / mass
    b = force(law, eta, x + h / 2 * v, v - h / 2 * a) / mass
    c = force(law, eta, x + h / 2 * (v - h / 2 * a), v - h / 2 * b) / mass
    d = force(law, eta, x + h * (v - h / 2 * b), v - h * c) / mass
    x += h * (v - h / 6 * (a + b + c))
    v -= h / 6 * (a + 2 * b + 2 * c + d)
    if (x > expected["overlap"]) expected["overlap"] = x
    if (++n % 64 == 0) {
      if (mass * (before - v) > expected["force"]) expected["force"] = mass * (before - v)
      before = v
    }
  }
  expected["duration"] = n * h
  expected["restitution"] = -v / speed
}

# particles.csv of a run into obtained[]: as expected[] (duration: rows with a force), ["speed"] at the start, ["last"] step
# with a force.
function measure(file,    line, f, rows, x, y, vx, distance, load) {
  delete obtained
  while ((getline line < file) > 0) {
    split(line, f, ",")
    if (f[2] == "0") { x = f[3]; y = f[4]; vx = f[5] }
    if (f[2] != "1") continue
    distance = sqrt((f[3] - x) ^ 2 + (f[4] - y) ^ 2)
    load = sqrt(f[12] ^ 2 + f[13] ^ 2)
    if (!rows++) obtained["speed"] = vx - f[5]
    if (2 * radius - distance > obtained["overlap"]) obtained["overlap"] = 2 * radius - distance
    if (load > obtained["force"]) obtained["force"] = load
    if (load > 0) { obtained["duration"]++; obtained["last"] = f[1] }
    obtained["parting"] = f[5] - vx
  }
  close(file)
  if (obtained["speed"]) obtained["restitution"] = obtained["parting"] / obtained["speed"]
}

# Value of a setting in a line of `runs`.
function setting(line, key,    at) {
  at = index(line, " " key "=")
  if (!at) return ""
  line = substr(line, at + length(key) + 2)
  sub(/ .*/, "", line)
  return line
}

function ratio(label, key, x, reference) { if (reference) print label, key, x / reference }

function impact(label, line,    damping, k) {
  damping = setting(line, "contact.damping")
  integrate(setting(line, "contact.law"), damping == "" ? 0.34 : damping, obtained["speed"])
  for (k = 1; k <= 4; k++) ratio(label, part[k] "_over_integration", obtained[part[k]], expected[part[k]])
}

# Figures of a run, and these over those of the same run by the law `overlap`, which comes before it.
function figures(label, line,    base, k) {
  measure(folder label "/particles.csv")
  base = label
  sub(/^law-[a-z]*/, "unified-lens-implicit", base)
  sub(/^impact-[a-z]*/, "impact-overlap", base)
  for (k = 1; k <= 4; k++) {
    value[label " " part[k]] = obtained[part[k]]
    if (label !~ /^impact/ && k > 2) continue
    print label, part[k], obtained[part[k]] + 0
    if (base != label) ratio(label, part[k] "_over_overlap", obtained[part[k]], value[base " " part[k]])
  }
  if (label ~ /^impact/) {
    impact(label, line)
    return
  }
  print label, "last_contact", obtained["last"] + 0
  if (base == label) return
  ratio(label, "kiss_time_over_overlap", value[label " pair.kiss_time"], value[base " pair.kiss_time"])
  ratio(label, "tumble_time_over_overlap", value[label " pair.tumble_time"], value[base " pair.tumble_time"])
}

{ value[$1 " " $2] = $3 }

END {
  constants()
  split("force overlap duration restitution", part)
  folder = FILENAME
  sub(/[^\/]*$/, "", folder)
  runs = REFERENCE
  sub(/[^\/]*$/, "runs", runs)
  while ((getline line < runs) > 0)
    if (match(line, /^(impact|law|unified-lens-implicit)-[^ ]*/)) figures(substr(line, 1, RLENGTH), line)
}
