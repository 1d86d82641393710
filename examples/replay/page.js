// Plays films: shapes, actors, their poses and contacts, as written by replay.cpp. Works with every three.js from r109 on
// that defines a global THREE.
(function () {
  'use strict';

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

  // ---- Renderer, light and camera
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({antialias: true, alpha: true});
  } catch (error) {
    element('failure').hidden = false;
    element('failure').textContent = 'This page needs WebGL, which this browser does not offer here.';
    return;
  }
  if (!('outputColorSpace' in renderer)) {
    if ('outputEncoding' in renderer) renderer.outputEncoding = THREE.sRGBEncoding;
    else renderer.gammaOutput = true;
  }
  renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFSoftShadowMap;
  element('stage').appendChild(renderer.domElement);

  const camera = new THREE.PerspectiveCamera(30, 1, 0.1, 100);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, renderer.domElement);
  controls.enableKeys = false;  // the arrow keys step through the frames
  const vector = (v) => new THREE.Vector3(v[0], v[1], v[2]);

  // ---- Light and floor, as large as what is seen
  function addStage(scene, film) {
    const eye = vector(film.camera.eye);
    const target = vector(film.camera.target);
    const reach = eye.distanceTo(target);
    scene.add(new THREE.HemisphereLight(colour('#ffffff'), colour('#b9b4ac'), 0.75));
    const sun = new THREE.DirectionalLight(colour('#fff3e0'), 0.85);
    const forward = target.clone().sub(eye).setZ(0).normalize();
    const right = new THREE.Vector3(forward.y, -forward.x, 0);
    sun.position.copy(target).addScaledVector(forward, -0.55 * reach).addScaledVector(right, -0.75 * reach);
    sun.position.z += 1.15 * reach;
    sun.target.position.copy(target);
    sun.castShadow = true;
    sun.shadow.mapSize.set(2048, 2048);
    sun.shadow.bias = -0.0005;
    sun.shadow.radius = 3;
    const frustum = sun.shadow.camera;
    frustum.left = frustum.bottom = -0.6 * reach;
    frustum.right = frustum.top = 0.6 * reach;
    frustum.near = 0.1 * reach;
    frustum.far = 4 * reach;
    scene.add(sun, sun.target);

    if (film.ground !== null) {
      const floor = new THREE.Mesh(
          new (THREE.PlaneBufferGeometry || THREE.PlaneGeometry)(20 * reach, 20 * reach),
          new THREE.ShadowMaterial({opacity: 0.28}));
      floor.position.z = film.ground;
      floor.receiveShadow = true;
      scene.add(floor);
    }
    return reach;
  }

  // ---- Shapes
  // Many small spheres need few triangles each, a few large ones need many.
  const kLargeSpheres = 48;
  const Icosahedron = THREE.IcosahedronBufferGeometry || THREE.IcosahedronGeometry;
  const Ball = THREE.SphereBufferGeometry || THREE.SphereGeometry;
  const fine = new Ball(1, 36, 24);
  const coarse = new Icosahedron(1, 2);

  // Every set of instances needs a geometry of its own: where the geometry stays the same from one draw call to the next,
  // old versions of three.js keep the instances, too.
  function sameGeometry(original) {
    const geometry = new THREE.BufferGeometry();
    geometry.index = original.index;
    geometry.attributes = original.attributes;
    return geometry;
  }

  function surfaceGeometry(shape) {
    const geometry = new THREE.BufferGeometry();
    const add = geometry.setAttribute ? 'setAttribute' : 'addAttribute';
    geometry[add]('position', new THREE.BufferAttribute(decode(shape.vertices, Float32Array), 3));
    geometry.setIndex(new THREE.BufferAttribute(decode(shape.triangles, Uint32Array), 1));
    geometry.computeVertexNormals();
    return geometry;
  }

  // Spheres by the geometry that draws them and, if the film says so, by colour.
  function sphereBatches(shape, film) {
    const spheres = decode(shape.spheres, Float32Array);
    const ramp = shape.sphere_colours ? decode(shape.sphere_colours, Uint8Array) : null;
    const members = new Map();
    for (let i = 0; 4 * i < spheres.length; ++i) {
      const key = (i < kLargeSpheres ? 'fine ' : 'coarse ') + (ramp ? film.ramp[ramp[i]] : '');
      if (!members.has(key)) members.set(key, []);
      members.get(key).push(i);
    }
    return Array.from(members, ([key, indices]) => {
      const matrices = new Float32Array(16 * indices.length);
      indices.forEach((sphere, n) => {
        const [x, y, z, r] = spheres.subarray(4 * sphere, 4 * sphere + 4);
        matrices.set([r, 0, 0, 0, 0, r, 0, 0, 0, 0, r, 0, x, y, z, 1], 16 * n);
      });
      const [detail, tint] = key.split(' ');
      const Attribute = THREE.InstancedBufferAttribute;
      return {
        geometry: sameGeometry(detail === 'fine' ? fine : coarse),
        tint,
        count: indices.length,
        matrices: new Attribute(matrices, 16),
      };
    });
  }

  // ---- Actors
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

  function withShadow(mesh) {
    mesh.castShadow = mesh.receiveShadow = true;
    return mesh;
  }

  function addActors(scene, film) {
    const shapes = film.shapes.map((shape) => ({
      surface: shape.triangles ? surfaceGeometry(shape) : null,
      batches: shape.spheres ? sphereBatches(shape, film) : [],
    }));
    return film.actors.map((actor) => {
      const shape = shapes[actor.shape];
      const body = new THREE.Group();
      const result = {body, colour: actor.colour, surface: null, spheres: new THREE.Group()};
      if (shape.surface) {
        result.surface = withShadow(new THREE.Mesh(shape.surface, material(actor.colour, false)));
        body.add(result.surface);
      }
      for (const batch of shape.batches) {
        const mesh = new THREE.InstancedMesh(batch.geometry, material(batch.tint || actor.colour, false), batch.count);
        mesh.instanceMatrix = batch.matrices;  // shared by all actors of the shape
        mesh.frustumCulled = false;
        result.spheres.add(withShadow(mesh));
      }
      body.add(result.spheres);
      scene.add(body);
      return result;
    });
  }

  // ---- Contacts: a dot at each point, a line along its normal, seen through everything
  function dot() {
    const canvas = document.createElement('canvas');
    canvas.width = canvas.height = 32;
    const pen = canvas.getContext('2d');
    pen.fillStyle = 'white';
    pen.arc(16, 16, 14, 0, 2 * Math.PI);
    pen.fill();
    return new THREE.CanvasTexture(canvas);
  }

  function addContacts(scene, film, reach) {
    if (!film.contacts) return null;
    const marks = decode(film.contacts, Float32Array);
    const first = decode(film.first_contacts, Uint32Array);
    let most = 1;
    for (let i = 1; i < first.length; ++i) most = Math.max(most, first[i] - first[i - 1]);
    const buffer = (count) => {
      const geometry = new THREE.BufferGeometry();
      const add = geometry.setAttribute ? 'setAttribute' : 'addAttribute';
      geometry[add]('position', new THREE.BufferAttribute(new Float32Array(3 * count), 3));
      return geometry;
    };
    const group = new THREE.Group();
    const red = colour('#d0021b');
    const dots = new THREE.Points(buffer(most), new THREE.PointsMaterial({
      color: red, size: 9, sizeAttenuation: false, map: dot(), transparent: true, alphaTest: 0.5, depthTest: false,
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
        const length = 0.035 * reach;
        ends.array.set([x, y, z, x + length * nx, y + length * ny, z + length * nz], 6 * i);
      }
      points.needsUpdate = ends.needsUpdate = true;
      dots.geometry.setDrawRange(0, count);
      lines.geometry.setDrawRange(0, 2 * count);
    }
    return {group, setFrame};
  }

  // ---- A film, ready to be shown
  function prepare(film) {
    const scene = new THREE.Scene();
    const reach = addStage(scene, film);
    const actors = addActors(scene, film);
    const contacts = addContacts(scene, film, reach);
    const poses = decode(film.poses, Float32Array);  // x y z, then the quaternion x y z w, of each actor in each frame
    const stride = 7 * actors.length;
    const frames = poses.length / stride;
    const from = new THREE.Quaternion();
    const to = new THREE.Quaternion();

    function setTime(time) {
      const exact = Math.min(Math.max(time * film.frame_rate, 0), frames - 1);
      const first = Math.min(Math.floor(exact), Math.max(frames - 2, 0));
      const t = exact - first;
      const next = Math.min(first + 1, frames - 1);
      actors.forEach((actor, n) => {
        const a = first * stride + 7 * n;
        const b = next * stride + 7 * n;
        const mix = (k) => poses[a + k] + t * (poses[b + k] - poses[a + k]);
        actor.body.position.set(mix(0), mix(1), mix(2));
        from.fromArray(poses, a + 3);
        to.fromArray(poses, b + 3);
        actor.body.quaternion.copy(from.slerp(to, t));
      });
      if (contacts) contacts.setFrame(Math.round(exact));
    }

    function setView(name) {
      for (const actor of actors) {
        const has_spheres = actor.spheres.children.length > 0;
        const as_spheres = name === 'spheres' || name === 'both' || !actor.surface;
        actor.spheres.visible = as_spheres;
        if (actor.surface) {
          const through = name === 'contacts' || (name === 'both' && has_spheres);
          actor.surface.visible = name !== 'spheres' || !has_spheres;
          actor.surface.material = material(actor.colour, through);
          actor.surface.castShadow = !through;
        }
      }
      if (contacts) contacts.group.visible = name === 'contacts';
    }

    const views = ['surface', 'spheres', 'both', 'contacts'].filter((name) =>
        (name === 'surface' || name === 'both' ? actors.some((actor) => actor.surface) : true) &&
        (name === 'spheres' || name === 'both' ? actors.some((actor) => actor.spheres.children.length) : true) &&
        (name === 'contacts' ? contacts : true));
    return {film, scene, reach, frames, duration: (frames - 1) / film.frame_rate, views, setTime, setView};
  }

  // ---- What is shown
  const prepared = new Map();
  let shown = null;
  let view = '';
  let time = 0;
  let playing = false;
  let last_tick = null;

  function setView(name) {
    view = shown.views.includes(name) ? name : shown.views[0];
    shown.setView(view);
    for (const button of element('views').children) {
      button.classList.toggle('on', button.dataset.view === view);
      button.hidden = !shown.views.includes(button.dataset.view);
    }
  }

  function setPlaying(on) {
    if (on && time >= shown.duration) time = 0;
    playing = on;
    last_tick = null;
    element('play').textContent = on ? '\u275A\u275A' : '\u25B6';
  }

  // What is left between the texts above and the controls below, which must not cover the picture.
  function freeRows() {
    const height = window.innerHeight;
    const below = [element('films-list'), element('player')].filter((part) => !part.hidden);
    const bottom = Math.min(height, ...below.map((part) => part.getBoundingClientRect().top));
    const header = document.querySelector('header').getBoundingClientRect();
    const top = header.width > 0.6 * window.innerWidth ? header.bottom : 0;
    return bottom - top > 0.3 * height ? [top, bottom] : [0, height];
  }

  function resize() {
    const width = window.innerWidth;
    const height = window.innerHeight;
    const [top, bottom] = freeRows();
    renderer.setSize(width, height, false);
    camera.aspect = width / (bottom - top);
    // A narrow window must not cut off the sides.
    const {field_of_view, aspect} = shown.film.camera;
    const half = Math.tan(field_of_view * Math.PI / 360) * Math.max(1, aspect / camera.aspect);
    camera.fov = Math.atan(half) * 360 / Math.PI;
    camera.setViewOffset(width, bottom - top, 0, -top, width, height);
  }

  function show(index) {
    if (!prepared.has(index)) prepared.set(index, prepare(films[index]));
    shown = prepared.get(index);
    const film = shown.film;
    document.title = film.title + ' - InnerSphere';
    element('title').textContent = film.title;
    element('caption').textContent = film.caption;
    element('notes').replaceChildren(...film.notes.map((note) => {
      const line = document.createElement('li');
      line.textContent = note;
      return line;
    }));
    Array.from(element('films-list').children).forEach((button, n) => button.classList.toggle('on', n === index));
    if (element('films-list').children[index]) element('films-list').children[index].scrollIntoView({inline: 'center'});
    camera.near = shown.reach / 100;
    camera.far = 20 * shown.reach;
    camera.position.copy(vector(film.camera.eye));
    controls.target.copy(vector(film.camera.target));
    controls.update();
    element('scrub').max = shown.duration;
    element('views').hidden = shown.views.length < 2;
    element('player').hidden = shown.frames < 2;
    time = 0;
    setView(view);
    setPlaying(shown.frames > 1);
    resize();
  }

  // ---- Controls
  films.forEach((film, index) => {
    const button = document.createElement('button');
    button.textContent = film.title;
    button.addEventListener('click', () => show(index));
    element('films-list').appendChild(button);
  });
  element('films-list').hidden = films.length < 2;
  element('scrub').addEventListener('input', (event) => { time = Number(event.target.value); setPlaying(false); });
  element('play').addEventListener('click', () => setPlaying(!playing));
  for (const button of element('views').children) {
    button.addEventListener('click', () => setView(button.dataset.view));
  }
  window.addEventListener('keydown', (event) => {
    if (event.target.tagName === 'SELECT') return;
    const views = {1: 'surface', 2: 'spheres', 3: 'both', 4: 'contacts'};
    const step = {ArrowLeft: -1, ArrowRight: 1}[event.key];
    if (event.key === ' ') setPlaying(!playing);
    else if (views[event.key]) setView(views[event.key]);
    else if (step) {
      time = Math.min(Math.max(time + step / shown.film.frame_rate, 0), shown.duration);
      setPlaying(false);
    } else return;
    event.preventDefault();
  });
  window.addEventListener('resize', resize);

  // A link can point at a film, a moment and a view: #film=2&t=2.5&paused&view=spheres
  const link = new URLSearchParams(location.hash.slice(1));
  view = link.get('view') || 'surface';
  show(Math.min(Math.max(Math.floor(Number(link.get('film')) || 0), 0), films.length - 1));
  if (link.has('t')) time = Math.min(Math.max(Number(link.get('t')) || 0, 0), shown.duration);
  if (link.has('paused')) setPlaying(false);

  function tick(now) {
    requestAnimationFrame(tick);
    if (playing && last_tick !== null) {
      time += Number(element('speed').value) * (now - last_tick) / 1000;
      if (time >= shown.duration) { time = shown.duration; setPlaying(false); }
    }
    last_tick = now;
    shown.setTime(time);
    element('scrub').value = time;
    element('time').textContent = time.toFixed(2) + ' / ' + shown.duration.toFixed(2) + ' s';
    controls.update();
    renderer.render(shown.scene, camera);
  }
  requestAnimationFrame(tick);
})();
