% Compares a solver with the right answers: octave reader.m vectors.json 1e-7
% Put your own simulator in place of `solve`; this one knows free bodies, wheels and constant moments.
1;

function values = numbers(entry)
  % Text of the question or of the truth; a matrix is a list of rows.
  text = entry;
  if isstruct(entry)
    text = entry.text;
  end
  if iscell(text{1})
    values = cell2mat(cellfun(@(row) str2double(row(:).'), text(:), "UniformOutput", false));
  else
    values = str2double(text(:));
  end
end

function rows = solve(question)
  % The rows are omega; a quaternion follows in your own solver.
  body = question.body;
  inertia = numbers(body.inertia);
  moment = numbers(body.moment);
  rotor = numbers(body.rotor);
  at = numbers(question.time.times);
  w = numbers(question.initial.omega);
  rate = @(w, t) inertia \ (cross(inertia * w + rotor, w) + moment);
  lsode_options("relative tolerance", 1e-12);
  lsode_options("absolute tolerance", 1e-12);
  rows = lsode(rate, w, at).';
end

words = argv();
questions = jsondecode(fileread(words{1})).questions;
right = 0;
wrong = 0;
for place = 1:numel(questions)
  asked = questions(place);
  if !any(strcmp(asked.kind, {"free", "wheels", "moment"}))
    continue
  end
  columns = asked.truth.columns;
  exact = [numbers(columns.w1), numbers(columns.w2), numbers(columns.w3)].';
  off = vecnorm(solve(asked.question) - exact) ./ vecnorm(exact);
  % A NaN is not within the tolerance.
  is_right = all(off <= str2double(words{2}));
  right += is_right;
  wrong += !is_right;
end
printf("%d right, %d wrong, %d not tried\n", right, wrong, numel(questions) - right - wrong);
exit(!(right > 0 && wrong == 0));
