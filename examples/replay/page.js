// Plays films: shapes, actors, their poses and contacts, as written by replay.cpp. Written against three.js r111, as a
// global THREE.
(function () {
  'use strict';

  // ---- What can be said without a page
  const kLongestStep = 1 / 20;  // [s] that a frame moves the film on by: a slow machine shows slow motion, not jumps
  const kHold = 1;              // [s] for which the end is seen before a loop starts again

  const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

  // The time after a frame that took `elapsed`. It runs beyond the end for as long as that is held.
  function advanced(time, elapsed, speed, duration, loop) {
    const next = time + speed * Math.min(elapsed, kLongestStep);
    if (next < duration) return next;
    if (!loop) return duration;
    return next < duration + speed * kHold ? next : 0;
  }

  // A link can point at a film, a moment and a view: #film=2&t=2.5&paused&view=spheres
  function parseLink(hash) {
    const link = new URLSearchParams(hash.replace(/^#/, ''));
    const number = (name) => isFinite(parseFloat(link.get(name))) ? parseFloat(link.get(name)) : null;
    return {film: number('film'), time: number('t'), view: link.get('view'), paused: link.has('paused')};
  }

  function markOf(holds) {
    if (holds === null) return {sign: '\u2013', kind: 'open'};
    return holds ? {sign: '\u2713', kind: 'good'} : {sign: '\u2717', kind: 'bad'};
  }

  // A heading for all notes of a film: the worst of them decides.
  function checksHeading(notes) {
    const count = (holds) => notes.filter((note) => note.holds === holds).length;
    const checks = (n) => n + (n === 1 ? ' check' : ' checks');
    if (count(false)) return {holds: false, text: count(false) + ' of ' + checks(notes.length) + ' missed'};
    if (!count(true)) return {holds: null, text: 'This film is too short for its checks'};
    if (count(null)) return {holds: true, text: count(true) + ' of ' + checks(notes.length) + ' passed so far'};
    return {holds: true, text: (notes.length > 1 ? 'All ' : '') + checks(notes.length) + ' passed'};
  }

  // ---- The page
  const element = (id) => document.getElementById(id);
  const films = JSON.parse(element('films').textContent);

  function decode(base64, type) {
    const text = atob(base64);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    return new type(bytes.buffer);
  }

  // Colours are sRGB in the film and linear in the shaders.
  const managed = THREE.ColorManagement && THREE.ColorManagement.enabled;
  function colour(css) {
    const result = new THREE.Color(css);
    return managed ? result : result.convertSRGBToLinear();
  }

  // ---- Renderer and camera
  const canvas = document.createElement('canvas');
  const gl = canvas.getContext('webgl2', {antialias: true, alpha: false});
  if (!gl) {
    element('failure').hidden = false;
    element('failure').textContent = 'This page needs WebGL 2, which this browser does not offer here.';
    return;
  }
  const renderer = new THREE.WebGLRenderer({canvas, context: gl});
  if (!('outputColorSpace' in renderer)) {
    if ('outputEncoding' in renderer) renderer.outputEncoding = THREE.sRGBEncoding;
    else renderer.gammaOutput = true;
  }
  renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.autoUpdate = false;  // only where something moved
  renderer.shadowMap.type = THREE.PCFSoftShadowMap;
  element('stage').appendChild(canvas);

  const camera = new THREE.PerspectiveCamera(30, 1, 0.1, 100);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.enableKeys = false;  // the arrow keys step through the frames

  // ---- Light and floor
  function addStage(scene, film, {centre, radius, forward, right}) {
    scene.add(new THREE.HemisphereLight(colour('#ffffff'), colour('#b9b4ac'), 0.75));
    const sun = new THREE.DirectionalLight(colour('#fff3e0'), 0.85);
    const ahead = forward.clone().setZ(0).normalize();
    sun.position.copy(centre).addScaledVector(ahead, -3 * radius).addScaledVector(right, -4 * radius);
    sun.position.z += 6.2 * radius;
    sun.target.position.copy(centre);
    sun.castShadow = true;
    sun.shadow.mapSize.set(2048, 2048);
    sun.shadow.bias = -0.0005;
    sun.shadow.radius = 3;
    const frustum = sun.shadow.camera;
    frustum.left = frustum.bottom = -2.5 * radius;
    frustum.right = frustum.top = 2.5 * radius;
    frustum.near = 0.5 * radius;
    frustum.far = 16 * radius;
    scene.add(sun, sun.target);

    if (film.ground === null) return null;
    const floor = new THREE.Mesh(
        new (THREE.PlaneBufferGeometry || THREE.PlaneGeometry)(100 * radius, 100 * radius), new THREE.ShadowMaterial());
    floor.material.depthWrite = false;  // it may be where a body's own face is
    floor.position.z = film.ground;
    floor.receiveShadow = true;
    scene.add(floor);
    return floor;
  }

  // ---- Shapes
  function setAttribute(geometry, name, values, size) {
    const attribute = new THREE.BufferAttribute(values, size);
    geometry[geometry.setAttribute ? 'setAttribute' : 'addAttribute'](name, attribute);
  }

  function surfaceGeometry(vertices, shape) {
    const geometry = new THREE.BufferGeometry();
    setAttribute(geometry, 'position', vertices, 3);
    geometry.setIndex(new THREE.BufferAttribute(decode(shape.triangles, Uint32Array), 1));
    geometry.computeVertexNormals();
    return geometry;
  }

  // One triangle for each sphere, which the shaders below turn to the eye. Its three vertices are alike: software
  // renderers pay for every instance of an instanced geometry as for a draw call, which is more than for two vertices.
  function sphereGeometry(spheres, shape, film) {
    const count = spheres.length / 4;
    const centres = new Float32Array(9 * count);
    const radii = new Float32Array(3 * count);
    let reach = 0;
    for (let i = 0; i < count; ++i) {
      const [x, y, z, radius] = spheres.subarray(4 * i, 4 * i + 4);
      centres.set([x, y, z, x, y, z, x, y, z], 9 * i);
      radii.fill(radius, 3 * i, 3 * i + 3);
      reach = Math.max(reach, Math.hypot(x, y, z) + radius);
    }
    const geometry = new THREE.BufferGeometry();
    setAttribute(geometry, 'position', centres, 3);
    setAttribute(geometry, 'radius', radii, 1);
    if (shape.sphere_colours) {
      const ramp = film.ramp.map((css) => colour(css).toArray());
      const colours = new Float32Array(9 * count);
      decode(shape.sphere_colours, Uint8Array).forEach((step, i) => {
        colours.set([...ramp[step], ...ramp[step], ...ramp[step]], 9 * i);
      });
      setAttribute(geometry, 'color', colours, 3);
    }
    geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(), reach);
    return geometry;
  }

  // The points (radius 0) or spheres that are farthest out in each of many directions: they bound a shape nearly as
  // well as all of them do.
  function outermost(items, stride) {
    const kDirections = 100;  // spread evenly, along a spiral
    const found = new Set();
    for (let n = 0; n < kDirections; ++n) {
      const z = 1 - (2 * n + 1) / kDirections;
      const x = Math.sqrt(1 - z * z) * Math.cos(2.399963 * n);
      const y = Math.sqrt(1 - z * z) * Math.sin(2.399963 * n);
      let best = 0;
      let farthest = -Infinity;
      for (let i = 0; i < items.length; i += stride) {
        const far = x * items[i] + y * items[i + 1] + z * items[i + 2] + (stride > 3 ? items[i + 3] : 0);
        if (far > farthest) [best, farthest] = [i, far];
      }
      found.add(best);
    }
    return Array.from(found, (i) => (
      {point: new THREE.Vector3(items[i], items[i + 1], items[i + 2]), radius: stride > 3 ? items[i + 3] : 0}));
  }

  function readShape(shape, film) {
    const vertices = shape.triangles ? decode(shape.vertices, Float32Array) : null;
    const spheres = shape.spheres ? decode(shape.spheres, Float32Array) : null;
    return {
      surface: vertices && surfaceGeometry(vertices, shape),
      spheres: spheres && sphereGeometry(spheres, shape, film),
      outline: vertices ? outermost(vertices, 3) : outermost(spheres, 4),
    };
  }

  // ---- Materials
  const materials = new Map();
  function material(css, through) {
    const key = css + through;
    if (!materials.has(key)) {
      materials.set(key, new THREE.MeshStandardMaterial({
        color: colour(css), roughness: 0.55, metalness: 0, side: THREE.DoubleSide, shadowSide: THREE.BackSide,
        transparent: through, opacity: through ? 0.3 : 1, depthWrite: !through,
      }));
    }
    return materials.get(key);
  }

  // Corner of a triangle around the unit circle, by the vertex's number.
  const kCorner = `
    attribute float radius;
    vec2 corner() {
      int n = gl_VertexID % 3;
      return n == 0 ? vec2(-sqrt(3.0), -1.0) : n == 1 ? vec2(sqrt(3.0), -1.0) : vec2(0.0, 2.0);
    }`;

  // Spheres are lit like surfaces, by three.js' own shaders, but at the point where the ray through a fragment meets
  // the sphere.
  function traceSpheres(shader) {
    const patch = (text, changes) => Object.keys(changes).reduce((result, chunk) => {
      if (!result.includes(chunk)) throw new Error('this three.js has no ' + chunk + ' here');
      return result.split(chunk).join(changes[chunk]);
    }, text);
    shader.vertexShader = patch(shader.vertexShader, {
      'void main() {': kCorner + `
        flat varying vec4 vSphere;  // as the eye sees it
        void main() {`,
      '#include <project_vertex>': `
        vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
        vSphere = vec4(mvPosition.xyz, radius);
        // The triangle holds the cone of rays that touch the sphere, and a margin for smooth edges.
        float away = length(mvPosition.xyz);
        float tangent = radius * inversesqrt(max(1.0 - radius * radius / (away * away), 0.01));
        vec3 ahead = mvPosition.xyz / away;
        vec3 right = normalize(cross(ahead, vec3(0.0, 1.0, 0.0)));
        vec2 place = (1.01 * tangent + 0.0005 * away) * corner();
        mvPosition.xyz += place.x * right + place.y * cross(right, ahead);
        gl_Position = projectionMatrix * mvPosition;`,
    });
    shader.fragmentShader = patch(shader.fragmentShader, {
      'void main() {': `
        uniform mat4 projectionMatrix;
        #if defined(USE_SHADOWMAP) && NUM_DIR_LIGHT_SHADOWS > 0
          uniform mat4 directionalShadowMatrix[NUM_DIR_LIGHT_SHADOWS];
        #endif
        flat varying vec4 vSphere;
        void main() {
          vec3 ray = -vViewPosition;
          float across = dot(ray, ray);
          float middle = dot(ray, vSphere.xyz) / across;
          float off = length(ray * middle - vSphere.xyz);  // of the ray's nearest point
          float covered = clamp(0.5 + (vSphere.w - off) / fwidth(off), 0.0, 1.0);
          if (covered == 0.0) discard;
          vec3 hit = ray * (middle - sqrt(max(vSphere.w * vSphere.w - off * off, 0.0) / across));
          vec4 place = projectionMatrix * vec4(hit, 1.0);
          gl_FragDepth = 0.5 + 0.5 * place.z / place.w;`,
      '#include <normal_fragment_begin>': `
          vec3 normal = normalize(hit - vSphere.xyz);
          vec3 geometryNormal = normal;
          diffuseColor.a = covered;
          vec4 hitPlace = vec4((hit - viewMatrix[3].xyz) * mat3(viewMatrix), 1.0);  // in the world`,
      '#include <lights_fragment_begin>': patch(THREE.ShaderChunk.lights_fragment_begin, {
        'vDirectionalShadowCoord[ i ]': '(directionalShadowMatrix[ i ] * hitPlace)',
      }),
    });
  }

  const sphere_materials = new Map();
  function sphereMaterial(css) {
    if (!sphere_materials.has(css)) {
      const result = new THREE.MeshStandardMaterial({
        color: colour(css || '#ffffff'), roughness: 0.55, metalness: 0, shadowSide: THREE.FrontSide,
        vertexColors: css === null,
      });
      result.onBeforeCompile = traceSpheres;
      sphere_materials.set(css, result);
    }
    return sphere_materials.get(css);
  }

  // In the light's view a sphere is a disc through its centre. It casts the sphere's shadow on all that is outside of
  // the sphere, and the sphere's lit side is in front of it.
  const disc = new THREE.ShaderMaterial({
    vertexShader: kCorner + `
      varying vec2 vPlace;
      void main() {
        vPlace = corner();
        vec4 place = modelViewMatrix * vec4(position, 1.0);
        place.xy += radius * vPlace;
        gl_Position = projectionMatrix * place;
      }`,
    fragmentShader: `
      #include <packing>
      varying vec2 vPlace;
      void main() {
        if (dot(vPlace, vPlace) > 1.0) discard;
        gl_FragColor = packDepthToRGBA(gl_FragCoord.z);
      }`,
  });

  // ---- Actors
  function addActors(scene, film, shapes) {
    return film.actors.map((actor) => {
      const shape = shapes[actor.shape];
      const result = {body: new THREE.Group(), colour: actor.colour, surface: null, spheres: null};
      if (shape.surface) result.surface = new THREE.Mesh(shape.surface, material(actor.colour, false));
      if (shape.spheres) {
        const tinted = film.shapes[actor.shape].sphere_colours;
        result.spheres = new THREE.Mesh(shape.spheres, sphereMaterial(tinted ? null : actor.colour));
        result.spheres.customDepthMaterial = disc;
        // Edges of traced spheres are smooth only where coverage follows alpha.
        result.spheres.onBeforeRender = () => gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
        result.spheres.onAfterRender = () => gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
      }
      for (const part of [result.surface, result.spheres]) {
        if (!part) continue;
        part.castShadow = part.receiveShadow = true;
        result.body.add(part);
      }
      scene.add(result.body);
      return result;
    });
  }

  // ---- Contacts: a dot at each point, a line along its normal, seen through everything
  function dot() {
    const picture = document.createElement('canvas');
    picture.width = picture.height = 32;
    const pen = picture.getContext('2d');
    pen.fillStyle = 'white';
    pen.arc(16, 16, 14, 0, 2 * Math.PI);
    pen.fill();
    return new THREE.CanvasTexture(picture);
  }

  function addContacts(scene, film, radius) {
    if (!film.contacts) return null;
    const marks = decode(film.contacts, Float32Array);
    const first = decode(film.first_contacts, Uint32Array);
    let most = 1;
    for (let i = 1; i < first.length; ++i) most = Math.max(most, first[i] - first[i - 1]);
    const buffer = (count) => {
      const geometry = new THREE.BufferGeometry();
      setAttribute(geometry, 'position', new Float32Array(3 * count), 3);
      return geometry;
    };
    const group = new THREE.Group();
    const red = colour('#d0021b');
    const dots = new THREE.Points(buffer(most), new THREE.PointsMaterial({
      color: red, sizeAttenuation: false, map: dot(), transparent: true, alphaTest: 0.5, depthTest: false,
    }));
    const lines = new THREE.LineSegments(buffer(2 * most), new THREE.LineBasicMaterial({
      color: red, depthTest: false, transparent: true,
    }));
    for (const part of [dots, lines]) {
      part.frustumCulled = false;
      part.renderOrder = 1;
      group.add(part);
    }
    scene.add(group);
    function setFrame(frame) {
      const count = first[frame + 1] - first[frame];
      const points = dots.geometry.attributes.position, ends = lines.geometry.attributes.position;
      for (let i = 0; i < count; ++i) {
        const at = 6 * (first[frame] + i);
        const [x, y, z, nx, ny, nz] = marks.subarray(at, at + 6);
        points.array.set([x, y, z], 3 * i);
        const length = 0.12 * radius;
        ends.array.set([x, y, z, x + length * nx, y + length * ny, z + length * nz], 6 * i);
      }
      points.needsUpdate = ends.needsUpdate = true;
      dots.geometry.setDrawRange(0, count);
      lines.geometry.setDrawRange(0, 2 * count);
    }
    function setScale(pixels) {  // of a metre
      dots.material.size = clamp(0.03 * radius * pixels, 2.5, 12);
    }
    return {group, setFrame, setScale};
  }

  // ---- What has to be seen, and from where
  function poseAt(poses, at) {
    return {
      position: new THREE.Vector3().fromArray(poses, at),
      turn: new THREE.Quaternion().fromArray(poses, at + 3),
    };
  }

  // Where things are at the end, or at some moments that stand for the whole film.
  function subjectOf(film, shapes, poses, frames) {
    const {azimuth, elevation, whole_film} = film.viewpoint;
    const level = Math.cos(elevation);
    const forward = new THREE.Vector3(
        -Math.sin(azimuth) * level, Math.cos(azimuth) * level, -Math.sin(elevation));
    const right = new THREE.Vector3().crossVectors(forward, camera.up).normalize();
    const up = new THREE.Vector3().crossVectors(right, forward);
    const kMoments = whole_film ? 8 : 0;
    const blobs = [];
    const box = new THREE.Box3();
    for (let moment = 0; moment <= kMoments; ++moment) {
      const frame = kMoments ? Math.floor(moment * (frames - 1) / kMoments) : frames - 1;
      film.actors.forEach((actor, n) => {
        const {position, turn} = poseAt(poses, 7 * (frame * film.actors.length + n));
        for (const {point, radius} of shapes[actor.shape].outline) {
          const place = point.clone().applyQuaternion(turn).add(position);
          blobs.push({place, radius});
          box.expandByPoint(place);
        }
      });
    }
    const centre = box.getCenter(new THREE.Vector3());
    let radius = 0;
    for (const blob of blobs) radius = Math.max(radius, blob.place.distanceTo(centre) + blob.radius);
    return {blobs, centre, radius, forward, right, up, tangent: Math.tan(film.viewpoint.field_of_view / 2)};
  }

  // How far away, and how far to the side, an eye has to be to see all blobs between two planes along `axis`.
  function fitAlong({blobs, centre, forward}, axis, tangent) {
    const widen = Math.sqrt(1 + tangent * tangent);
    let positive = -Infinity;
    let negative = -Infinity;
    const from = new THREE.Vector3();
    for (const {place, radius} of blobs) {
      from.copy(place).sub(centre);
      const margin = radius * widen - from.dot(forward) * tangent;
      positive = Math.max(positive, from.dot(axis) + margin);
      negative = Math.max(negative, -from.dot(axis) + margin);
    }
    return {distance: (positive + negative) / (2 * tangent), offset: (positive - negative) / 2};
  }

  // The nearest eye that sees all of a subject in a picture of this aspect.
  function fit(subject, aspect) {
    const kMargin = 1.08;
    const across = fitAlong(subject, subject.right, subject.tangent * aspect / kMargin);
    const along = fitAlong(subject, subject.up, subject.tangent / kMargin);
    const target = subject.centre.clone().addScaledVector(subject.right, across.offset)
        .addScaledVector(subject.up, along.offset);
    const distance = Math.max(across.distance, along.distance);
    return {target, distance, eye: target.clone().addScaledVector(subject.forward, -distance)};
  }

  // ---- A film, ready to be shown
  function prepare(film) {
    const scene = new THREE.Scene();
    const shapes = film.shapes.map((shape) => readShape(shape, film));
    const poses = decode(film.poses, Float32Array);  // x y z, then the quaternion x y z w, of each actor in each frame
    const stride = 7 * film.actors.length;
    const frames = poses.length / stride;
    const subject = subjectOf(film, shapes, poses, frames);
    const floor = addStage(scene, film, subject);
    const actors = addActors(scene, film, shapes);
    const contacts = addContacts(scene, film, subject.radius);

    function setTime(time) {
      const exact = clamp(time * film.frame_rate, 0, frames - 1);
      const first = Math.min(Math.floor(exact), Math.max(frames - 2, 0));
      const next = Math.min(first + 1, frames - 1);
      actors.forEach(({body}, n) => {
        const from = poseAt(poses, first * stride + 7 * n);
        const to = poseAt(poses, next * stride + 7 * n);
        body.position.copy(from.position.lerp(to.position, exact - first));
        body.quaternion.copy(from.turn.slerp(to.turn, exact - first));
      });
      if (contacts) contacts.setFrame(Math.round(exact));
    }

    function setView(name) {
      for (const {surface, spheres, colour: css} of actors) {
        if (spheres) spheres.visible = name === 'spheres' || name === 'both' || !surface;
        if (!surface) continue;
        const through = name === 'contacts' || (name === 'both' && spheres);
        surface.visible = name !== 'spheres' || !spheres;
        surface.material = material(css, Boolean(through));
        surface.castShadow = !through;
      }
      if (contacts) contacts.group.visible = name === 'contacts';
    }

    const has_surface = actors.some((actor) => actor.surface);
    const has_spheres = actors.some((actor) => actor.spheres);
    const offered = {surface: has_surface, spheres: has_spheres, both: has_surface && has_spheres, contacts};
    const views = Object.keys(offered).filter((name) => offered[name]);
    const duration = (frames - 1) / film.frame_rate;
    return {film, scene, subject, floor, contacts, frames, duration, views, setTime, setView};
  }

  // ---- What is shown
  const prepared = new Map();
  let index = -1;      // of the film
  let shown = null;    // the film, prepared
  let view = null;     // that the user chose
  let time = 0;
  let playing = false;
  let loop = true;     // films are short, and a page that has come to a stop looks broken
  let aimed = false;   // the user chose where to look from
  let moved = true;    // since the last picture: things
  let stale = true;    // since the last picture: anything
  let pictures = 0;    // of this film so far
  let last_tick = 0;

  function setTime(seconds) {
    time = seconds;
    moved = true;
  }

  function setView(name) {
    if (name) view = name;
    const wanted = view || (shown.frames > 1 ? 'surface' : 'both');
    const seen = shown.views.includes(wanted) ? wanted : shown.views[0];
    shown.setView(seen);
    for (const button of element('views').children) {
      button.setAttribute('aria-pressed', button.dataset.view === seen);
      button.hidden = !shown.views.includes(button.dataset.view);
    }
    moved = true;
  }

  const kPlay = '<svg viewBox="0 0 24 24"><path d="M8 5v14l11-7z"/></svg>';
  const kPause = '<svg viewBox="0 0 24 24"><path d="M7 5h3.5v14H7zM13.5 5H17v14h-3.5z"/></svg>';
  function setPlaying(on) {
    playing = on && shown.frames > 1;
    element('play').innerHTML = playing ? kPause : kPlay;
    element('play').setAttribute('aria-label', playing ? 'Pause' : 'Play');
  }

  function togglePlaying() {
    if (!playing && time >= shown.duration) setTime(0);
    setPlaying(!playing);
  }

  function setLoop(on) {
    loop = on;
    element('loop').setAttribute('aria-pressed', on);
  }

  function step(count) {
    setTime(clamp(Math.min(time, shown.duration) + count / shown.film.frame_rate, 0, shown.duration));
    setPlaying(false);
  }

  // What the texts and the controls leave free: below the texts, and beside them where that is wide enough.
  function freeAreas() {
    const width = window.innerWidth;
    const height = window.innerHeight;
    const header = document.querySelector('header').getBoundingClientRect();
    const bottom = element('bottom').getBoundingClientRect().top;
    const areas = [
      {left: 0, top: header.bottom, right: width, bottom},
      {left: header.right, top: 0, right: width, bottom},
    ].filter((area) => area.right - area.left > 0.5 * width && area.bottom - area.top > 0.3 * height);
    return areas.length ? areas : [{left: 0, top: 0, right: width, bottom: height}];
  }

  function resize() {
    let best = null;
    for (const area of freeAreas()) {
      const width = area.right - area.left;
      const height = area.bottom - area.top;
      const {target, eye, distance} = fit(shown.subject, width / height);
      if (!best || height / distance > best.scale) best = {area, width, height, target, eye, scale: height / distance};
    }
    element('films-list').children[index].scrollIntoView({block: 'nearest', inline: 'center'});
    renderer.setSize(window.innerWidth, window.innerHeight, false);
    camera.fov = shown.film.viewpoint.field_of_view * 180 / Math.PI;
    camera.aspect = best.width / best.height;
    camera.near = shown.subject.radius / 50;
    camera.far = 50 * shown.subject.radius;
    camera.setViewOffset(
        best.width, best.height, -best.area.left, -best.area.top, window.innerWidth, window.innerHeight);
    if (!aimed) {
      camera.position.copy(best.eye);
      controls.target.copy(best.target);
      controls.update();
    }
    stale = true;
  }

  function setColours() {
    const dark = window.matchMedia('(prefers-color-scheme: dark)').matches;
    const paper = getComputedStyle(document.documentElement).getPropertyValue('--paper').trim();
    renderer.setClearColor(new THREE.Color(paper));
    if (shown.floor) shown.floor.material.opacity = dark ? 0.5 : 0.28;
    stale = true;
  }

  function showNotes(notes) {
    const line = (mark, text) => {
      const sign = document.createElement('span');
      sign.className = 'mark ' + mark.kind;
      sign.textContent = mark.sign;
      return [sign, ' ' + text];
    };
    const heading = checksHeading(notes);
    element('checks').hidden = notes.length === 0;
    element('checks').firstElementChild.replaceChildren(...line(markOf(heading.holds), heading.text));
    element('notes').replaceChildren(...notes.map((note) => {
      const item = document.createElement('li');
      item.append(...line(markOf(note.holds), note.text));
      return item;
    }));
  }

  function show(wanted) {
    index = clamp(Math.floor(wanted), 0, films.length - 1);
    const film = films[index];
    if (!prepared.has(index)) prepared.set(index, prepare(film));
    shown = prepared.get(index);
    document.title = film.title + ' - InnerSphere';
    element('title').textContent = film.title;
    element('caption').textContent = film.caption.replace(/(\d) (?=\S)/g, '$1\u00a0');  // units stay with numbers
    showNotes(film.notes);
    Array.from(element('films-list').children).forEach((button, n) => {
      button.setAttribute('aria-pressed', n === index);
    });
    element('scrub').max = shown.duration;
    element('views').hidden = shown.views.length < 2;
    for (const part of document.querySelectorAll('.timed')) part.hidden = shown.frames < 2;
    element('player').classList.toggle('still', shown.frames < 2);
    aimed = false;
    pictures = 0;
    setTime(0);
    setView();
    setColours();
    resize();
  }

  // What a link does not name stays as it is.
  function follow(link) {
    if (link.film !== null && clamp(Math.floor(link.film), 0, films.length - 1) !== index) show(link.film);
    if (link.view) setView(link.view);
    if (link.time !== null) {
      setTime(clamp(link.time, 0, shown.duration));
      setPlaying(true);
    }
    if (link.paused) setPlaying(false);
  }

  // ---- Controls
  function toggleFullScreen() {
    if (document.fullscreenElement) document.exitFullscreen();
    else if (document.fullscreenEnabled) document.documentElement.requestFullscreen();
  }

  films.forEach((film, n) => {
    const button = document.createElement('button');
    button.textContent = film.title;
    button.addEventListener('click', () => show(n));
    element('films-list').appendChild(button);
  });
  element('films-list').hidden = films.length < 2;
  element('full').hidden = !document.fullscreenEnabled;
  element('checks').open = window.innerWidth > 900 && window.innerHeight > 520;
  element('checks').addEventListener('toggle', resize);
  element('scrub').addEventListener('input', (event) => { setTime(Number(event.target.value)); setPlaying(false); });
  element('play').addEventListener('click', togglePlaying);
  element('loop').addEventListener('click', () => setLoop(!loop));
  element('full').addEventListener('click', toggleFullScreen);
  element('keys').addEventListener('click', () => element('help').showModal());
  for (const button of element('views').children) {
    button.addEventListener('click', () => setView(button.dataset.view));
  }
  // A button that was clicked gives the space bar back; one that was reached by keys keeps it.
  window.addEventListener('click', (event) => {
    if (event.detail > 0 && event.target.closest('button, summary')) document.activeElement.blur();
  });

  const keys = {
    ' ': togglePlaying,
    ArrowLeft: () => step(-1),
    ArrowRight: () => step(1),
    1: () => setView('surface'),
    2: () => setView('spheres'),
    3: () => setView('both'),
    4: () => setView('contacts'),
    '[': () => show((index + films.length - 1) % films.length),
    ']': () => show((index + 1) % films.length),
    l: () => setLoop(!loop),
    r: () => { setTime(0); setPlaying(true); },
    f: toggleFullScreen,
    '?': () => element('help').showModal(),
  };
  window.addEventListener('keydown', (event) => {
    // The right Alt key, which types brackets on many keyboards, is none that belongs to the browser.
    const browsers = (event.ctrlKey || event.altKey || event.metaKey) && !event.getModifierState('AltGraph');
    if (browsers || element('help').open || event.target.closest('select')) return;
    if (event.key === ' ' && event.target.closest('button, summary')) return;
    const act = keys[event.key] || keys[event.key.toLowerCase()];
    if (!act) return;
    act();
    event.preventDefault();
  });
  window.addEventListener('resize', resize);
  window.addEventListener('hashchange', () => follow(parseLink(location.hash)));
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', setColours);
  controls.addEventListener('start', () => { aimed = true; });
  controls.addEventListener('change', () => { stale = true; });

  // ---- Pictures, where there is something new to see
  function draw() {
    if (moved) {
      shown.setTime(time);
      const seconds = Math.min(time, shown.duration);
      element('scrub').value = seconds;
      element('time').textContent = seconds.toFixed(2) + ' / ' + shown.duration.toFixed(2) + ' s';
      renderer.shadowMap.needsUpdate = true;
    }
    if (shown.contacts) {
      const distance = camera.position.distanceTo(controls.target);
      shown.contacts.setScale(camera.projectionMatrix.elements[5] * window.innerHeight / (2 * distance));
    }
    renderer.render(shown.scene, camera);
    moved = stale = false;
    ++pictures;
  }

  function tick(now) {
    requestAnimationFrame(tick);
    // The first pictures wait for shaders: the clock starts behind them.
    if (playing && pictures > 1) {
      setTime(advanced(time, (now - last_tick) / 1000, Number(element('speed').value), shown.duration, loop));
      if (!loop && time === shown.duration) setPlaying(false);
    }
    last_tick = now;
    if (moved || stale || pictures < 2) draw();
  }

  show(0);
  setPlaying(!window.matchMedia('(prefers-reduced-motion: reduce)').matches);
  follow(parseLink(location.hash));
  requestAnimationFrame(tick);
})();
