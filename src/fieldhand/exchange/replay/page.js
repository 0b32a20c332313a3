"use strict";
(() => {
  const film = JSON.parse(document.getElementById("film").textContent);
  const find = (id) => document.getElementById(id);
  const canvas = find("map");
  const pen = canvas.getContext("2d");
  const ramp = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
  const zoneLook = {
    boundary: ["#f7f4ea", "#8a7f66"], keep_out: ["#bfd7e6", "#4d7c99"], zone: ["#efdcae", "#c19a3f"],
  };
  const markerLook = { start: "#1a7f37", end: "#b3261e", charger: "#d48806" };
  let now = 0, playing = false, last = 0, speed = film.seconds / 20;

  const box = (() => {
    const points = film.trees.concat(film.track.map((p) => [p[1], p[2]]), film.markers.map((m) => [m.x, m.y]));
    for (const zone of film.zones) points.push(...zone.ring);
    const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
    for (const [x, y] of points) {
      low[0] = Math.min(low[0], x); low[1] = Math.min(low[1], y);
      high[0] = Math.max(high[0], x); high[1] = Math.max(high[1], y);
    }
    const margin = 0.04 * Math.max(high[0] - low[0], high[1] - low[1], 5);
    return { west: low[0] - margin, south: low[1] - margin, east: high[0] + margin, north: high[1] + margin };
  })();
  let scale = 1;
  const sx = (x) => (x - box.west) * scale;
  const sy = (y) => (box.north - y) * scale;

  // The value of column k at time t; rows begin with their time.
  const between = (rows, t, k) => {
    let low = 0, high = rows.length - 1;
    if (t <= rows[0][0]) return rows[0][k];
    if (t >= rows[high][0]) return rows[high][k];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (rows[middle][0] <= t) low = middle; else high = middle;
    }
    const span = rows[high][0] - rows[low][0];
    const part = span > 0 ? (t - rows[low][0]) / span : 1;
    return rows[low][k] + part * (rows[high][k] - rows[low][k]);
  };

  const colour = (part) => {
    const at = Math.min(Math.max(part, 0), 1) * (ramp.length - 1);
    const k = Math.min(Math.floor(at), ramp.length - 2);
    const mixed = ramp[k].map((c, i) => Math.round(c + (at - k) * (ramp[k + 1][i] - c)));
    return `rgb(${mixed.join(",")})`;
  };

  const dot = (x, y, radius, fill, edge) => {
    pen.beginPath();
    pen.arc(sx(x), sy(y), radius, 0, 2 * Math.PI);
    pen.fillStyle = fill;
    pen.fill();
    if (edge) { pen.strokeStyle = edge; pen.lineWidth = 1.5; pen.stroke(); }
  };

  // A small flag above the place, so that it covers neither the place nor what was read there.
  const flag = (sign) => {
    const left = sx(sign.x) + 3 + 17 * sign.beside, top = sy(sign.y) - 22;
    pen.fillStyle = "#8a3b00";
    pen.fillRect(left - 3, top, 2, 22);
    pen.fillRect(left - 3, top, 15, 14);
    pen.fillStyle = "#fff";
    pen.font = "bold 12px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.fillText(sign.mark, left + 4.5, top + 11);
  };

  // A name on white, so that it is read above trees.
  const write = (words, x, y, ink) => {
    pen.strokeStyle = "#fff";
    pen.lineWidth = 4;
    pen.lineJoin = "round";
    pen.strokeText(words, x, y);
    pen.fillStyle = ink;
    pen.fillText(words, x, y);
  };

  const order = { boundary: 0, zone: 1, keep_out: 2 };
  const zones = film.zones.slice().sort((a, b) => order[a.kind] - order[b.kind]);
  const ground = () => {
    for (const zone of zones) {
      pen.beginPath();
      zone.ring.forEach(([x, y], k) => (k ? pen.lineTo(sx(x), sy(y)) : pen.moveTo(sx(x), sy(y))));
      pen.closePath();
      [pen.fillStyle, pen.strokeStyle] = zoneLook[zone.kind];
      pen.lineWidth = 1.2;
      pen.fill();
      pen.stroke();
    }
    const radius = Math.min(Math.max(0.17 * film.spacing * scale, 1), 6);
    for (const [x, y] of film.trees) dot(x, y, radius, "#5b8c5a");
    pen.font = "13px system-ui, sans-serif";
    pen.textAlign = "center";
    for (const block of film.blocks) {
      pen.beginPath();
      block.ring.forEach(([x, y], k) => (k ? pen.lineTo(sx(x), sy(y)) : pen.moveTo(sx(x), sy(y))));
      pen.strokeStyle = "#8fa08d";
      pen.lineWidth = 1;
      pen.stroke();
      const across = block.ring.map(([x]) => sx(x)), down = block.ring.map(([, y]) => sy(y));
      write(block.name, (Math.min(...across) + Math.max(...across)) / 2, (Math.min(...down) + Math.max(...down)) / 2, "#2f2f2f");
    }
    for (const zone of zones) {
      if (zone.kind === "boundary" || !zone.name) continue;
      const across = zone.ring.map(([x]) => sx(x)), down = zone.ring.map(([, y]) => sy(y));
      write(zone.name, (Math.min(...across) + Math.max(...across)) / 2, Math.max(...down) + 14, zoneLook[zone.kind][1]);
    }
    for (const marker of film.markers) {
      const ink = markerLook[marker.name] || "#2f2f2f";
      dot(marker.x, marker.y, 6, ink, "#fff");
      pen.fillStyle = ink;
      pen.fillText(marker.name, sx(marker.x), sy(marker.y) + 20);
    }
  };

  const range = (key) => {
    let low = Infinity, high = -Infinity;
    for (const capture of film.captures) {
      const value = capture.readings[key];
      if (value !== undefined) { low = Math.min(low, value); high = Math.max(high, value); }
    }
    return [low, high];
  };

  const draw = () => {
    pen.clearRect(0, 0, canvas.width, canvas.height);
    ground();
    const closed = film.signs.filter((s) => s.t <= now && s.blocked).pop();
    for (const ring of closed ? closed.blocked : []) {
      pen.beginPath();
      ring.forEach(([x, y], k) => (k ? pen.lineTo(sx(x), sy(y)) : pen.moveTo(sx(x), sy(y))));
      pen.closePath();
      pen.fillStyle = "rgba(179, 38, 30, 0.35)";
      pen.strokeStyle = "#b3261e";
      pen.lineWidth = 1.5;
      pen.fill();
      pen.stroke();
    }
    const x = between(film.track, now, 1), y = between(film.track, now, 2);
    pen.beginPath();
    pen.moveTo(sx(film.track[0][1]), sy(film.track[0][2]));
    for (const corner of film.track) {
      if (corner[0] > now) break;
      pen.lineTo(sx(corner[1]), sy(corner[2]));
    }
    pen.lineTo(sx(x), sy(y));
    pen.strokeStyle = "#26324f";
    pen.lineWidth = 2;
    pen.lineJoin = "round";
    pen.stroke();
    const key = find("quantity").value;
    const [low, high] = range(key);
    const done = film.captures.filter((capture) => capture.t <= now);
    const made = done.filter((capture) => capture.good).length;
    // What was read lies on top of other captures of the same place.
    for (const capture of done.filter((c) => c.readings[key] === undefined)) {
      dot(capture.x, capture.y, 5, capture.good ? "#6a3d9a" : "#b3261e", "#fff");
    }
    for (const capture of done.filter((c) => c.readings[key] !== undefined)) {
      dot(capture.x, capture.y, 7, colour(high > low ? (capture.readings[key] - low) / (high - low) : 0.5), "#fff");
    }
    for (const sign of film.signs.filter((s) => s.t <= now)) flag(sign);
    dot(x, y, 6, "#26324f", "#fff");
    const whole = Math.round(now);
    const clock = `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
    find("clock").textContent = clock;
    find("battery").textContent = `Battery ${between(film.charge, now, 1).toFixed(0)} %`;
    find("made").textContent = `${made} capture${made === 1 ? "" : "s"}`;
    find("time").value = String(now);
    find("time").setAttribute("aria-valuetext", clock);
    let shown = null;
    lines.forEach((line, k) => {
      line.hidden = film.lines[k][0] > now;
      if (!line.hidden) shown = line;
    });
    if (shown) list.scrollTop = shown.offsetTop - list.offsetTop - list.clientHeight + shown.offsetHeight;
  };

  const list = find("lines");
  const lines = film.lines.map(([, text]) => {
    const line = document.createElement("li");
    line.textContent = text;
    list.append(line);
    return line;
  });

  const fit = () => {
    const width = canvas.clientWidth;
    const tallest = Math.max(240, 0.7 * window.innerHeight);
    const shape = (box.north - box.south) / (box.east - box.west);
    const height = Math.min(width * shape, tallest);
    const dots = window.devicePixelRatio || 1;
    canvas.style.height = `${height}px`;
    canvas.width = Math.round(width * dots);
    canvas.height = Math.round(height * dots);
    scale = Math.min(width / (box.east - box.west), height / (box.north - box.south));
    const spare = (width - scale * (box.east - box.west)) / 2;
    pen.setTransform(dots, 0, 0, dots, spare * dots, 0);
    draw();
  };

  const legend = () => {
    const key = find("quantity").value;
    const known = film.quantities.find((q) => q.key === key);
    find("legend").hidden = !known;
    if (!known) return;
    const [low, high] = range(key);
    find("low").textContent = `${Number(low.toPrecision(4))} ${known.unit}`;
    find("high").textContent = `${Number(high.toPrecision(4))} ${known.unit}`;
  };

  const play = (on) => {
    playing = on;
    find("play").textContent = on ? "Pause" : "Play";
    if (!on) return;
    if (now >= film.seconds) now = 0;
    last = performance.now();
    requestAnimationFrame(step);
  };
  const step = (at) => {
    if (!playing) return;
    now = Math.min(film.seconds, now + (Math.max(0, at - last) / 1000) * speed);
    last = at;
    draw();
    if (now >= film.seconds) play(false); else requestAnimationFrame(step);
  };

  find("meanings").hidden = !film.meanings.length;
  for (const [mark, words] of film.meanings) {
    const sign = document.createElement("b");
    sign.textContent = mark;
    const meaning = document.createElement("span");
    meaning.append(sign, words);
    find("meanings").append(meaning);
  }
  for (const quantity of film.quantities) find("quantity").append(new Option(quantity.name, quantity.key));
  for (const length of [10, 20, 60]) find("speed").append(new Option(`${length} s in all`, String(length)));
  find("speed").append(new Option("as it was", "0"));
  find("speed").value = "20";
  find("speed").addEventListener("change", (e) => { speed = Number(e.target.value) ? film.seconds / e.target.value : 1; });
  find("quantity").addEventListener("change", () => { legend(); draw(); });
  find("time").max = String(film.seconds);
  find("time").addEventListener("input", (e) => { play(false); now = Number(e.target.value); draw(); });
  find("play").addEventListener("click", () => play(!playing));
  window.addEventListener("resize", fit);
  const given = /^#t=([0-9.]+)$/.exec(location.hash);
  now = given ? Math.min(film.seconds, Number(given[1])) : film.seconds;
  legend();
  fit();
})();
