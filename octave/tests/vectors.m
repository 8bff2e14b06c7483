% Every vector through both functions: whole signals, single steps, and a state saved and restored
% in the middle of a run.
function vectors()
folder = fullfile(fileparts(mfilename('fullpath')), '..', '..', 'vectors');
files = dir(fullfile(folder, '*.json'));
model = [tempname() '.json'];
tidy = onCleanup(@() delete(model));
samples = 0;
for n = 1:numel(files)
    file = fileread(fullfile(folder, files(n).name));
    vector = jsondecode(file);
    % Of the text itself: jsondecode would round nothing, but jsonencode might.
    write_text(model, model_text(file));
    runs = vector.runs;
    if isstruct(runs)
        runs = num2cell(runs);
    end
    for k = 1:numel(runs)
        run = runs{k};
        time = [];
        if isfield(run, 'dt')
            time = cumsum(run.dt);
        end
        if strcmp(vector.kind, 'forward')
            [given, wanted, tolerance] = deal(run.input, run.output, vector.tolerance.output);
            call = @(block, at, time) sf_MKP(block, given(at), around(run, at, time){:});
            name = 'sf_MKP';
        else
            [given, wanted, tolerance] = deal(run.target, run.input, vector.tolerance.input);
            limits = {};
            if isfield(run, 'drive_range')
                limits = {'drive_range', run.drive_range', 'horizon', run.horizon};
            end
            call = @(block, at, time) sf_Inverse_MKP(block, given(at), 'heading', run.heading(at), ...
                'tolerance', run.tolerance, limits{:}, around(run, at, time){:});
            name = 'sf_Inverse_MKP';
            [~, status] = call(model, 1:numel(given), time);
            assert(isequal(double(status), run.status));
        end
        whole = call(model, 1:numel(given), time);
        assert(max(abs(whole - wanted)) <= tolerance, '%s, run %d', files(n).name, k);
        block = feval(name, 'open', model);
        other = feval(name, 'open', model);
        for at = 1:numel(given)
            if mod(at, 7) == 0
                saved = feval(name, 'save', block);
                [block, other] = deal(other, block);
                feval(name, 'restore', block, saved);
            end
            assert(isequal(call(block, at, time), whole(at)));
        end
        feval(name, 'close', block);
        feval(name, 'close', other);
        samples = samples + numel(given);
    end
end
assert(numel(files) >= 30 && samples > 7000);
printf('vectors: %d files, %d samples, as whole signals and step by step\n', numel(files), samples);
end

% Time and load of samples, where the run has them.
function named = around(run, at, time)
named = {};
if isfield(run, 'dt')
    named = {'time', time(at)};
end
if isfield(run, 'load')
    named = [named, {'load', run.load(at)}];
end
end

% The object behind the key "model", by counting braces: model files have none inside texts.
function text = model_text(file)
start = regexp(file, '"model":\s*\{', 'end');
depth = cumsum((file(start:end) == '{') - (file(start:end) == '}'));
text = file(start:start + find(depth == 0, 1) - 1);
end
