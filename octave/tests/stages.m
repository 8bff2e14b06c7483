% A model with every stage: time, load, start, limits, whole signals and step by step.
function stages()
model = [tempname() '.json'];
tidy = onCleanup(@() delete(model));
write_whole(model);
n = 0:199;
u = 0.5 - 0.5 * cos(0.13 * n) .* cos(0.017 * n);
t = 0.1 * n;
L = 125 + 70 * sin(0.03 * n);

info = sf_MKP('info', model);
assert(info.needs_time && info.needs_load && info.fitted_start);
assert(strcmp(info.load, 'stress [MPa]') && isequal(info.load_range, [50 200]));
assert(isequal(info.drive_range, [0 1]) && isequal(size(info.active_range), [1 2]));

% A block that gets one sample at a time goes on where the last one ended, also after a restore.
[y, clipped] = sf_MKP(model, u, 'time', t, 'load', L);
assert(all(isfinite(y)) && strcmp(class(clipped), 'int8'));
block = sf_MKP('open', model);
other = sf_MKP('open', model);
for k = 1:numel(u)
    if mod(k, 7) == 0
        saved = sf_MKP('save', block);
        [block, other] = deal(other, block);
        sf_MKP('restore', block, saved);
        assert(isequal(sf_MKP('save', block), saved));
    end
    assert(isequal(sf_MKP(block, u(k), 'time', t(k), 'load', L(k)), y(k)));
end
assert(sf_MKP('temperature', block) > 20);
parts = [sf_MKP('open', model)];
assert(isequal([sf_MKP(parts, u(1:80), 'time', t(1:80), 'load', L(1:80)), ...
    sf_MKP(parts, u(81:end), 'time', t(81:end), 'load', L(81:end))], y));

% One load for all samples; at one load the model needs none.
constant = sf_MKP(model, u, 'time', t, 'load', 100);
assert(isequal(constant, sf_MKP(model, u, 'time', t, 'load', 100 * ones(size(u)))));
at_load = sf_MKP('open', model, 'load', 100);
assert(max(abs(sf_MKP(at_load, u, 'time', t) - constant)) < 1e-9);
% One array for two arguments.
assert(isequal(sf_MKP(model, t / 20, 'time', t / 20, 'load', 100), ...
    sf_MKP(model, t / 20, 'time', t / 20 + 0, 'load', 100)));

% Starts.
fitted = sf_MKP(model, 0.1, 'load', 100);
off = sf_MKP(model, 0.1, 'load', 100, 'start', 'off');
on = sf_MKP(model, 0.1, 'load', 100, 'start', 'on');
assert(on < off && fitted ~= off); % the output falls with the temperature
block = sf_MKP('open', model, 'start', 'on');
assert(isequal(sf_MKP(block, 0.1, 'load', 100), on));
for start = {'off', off; 'on', on; 'fitted', fitted}'
    sf_MKP('reset', block, start{1});
    assert(isequal(sf_MKP(block, 0.1, 'load', 100), start{2}));
end

% The inverse in front of the model gives the target where it says so, within its limits.
wanted = 0.5 + 2 * cos(0.05 * n);
limits = {'time', t, 'load', L, 'drive_range', [0 0.5]};
[drive, status] = sf_Inverse_MKP(model, wanted, limits{:});
reached = sf_MKP(model, drive, 'time', t, 'load', L);
inside = status == 0;
assert(any(inside) && any(status == 3) && all(drive >= 0 & drive <= 0.5));
assert(max(abs(reached(inside) - wanted(inside))) < 1e-9);
block = sf_Inverse_MKP('open', model);
for k = 1:numel(wanted)
    found = sf_Inverse_MKP(block, wanted(k), 'time', t(k), 'load', L(k), 'drive_range', [0 0.5]);
    assert(isequal(found, drive(k)));
end
calm = sf_Inverse_MKP(model, wanted, limits{:}, 'horizon', 1);
assert(sum(abs(diff(calm))) < sum(abs(diff(drive))));
free = sf_Inverse_MKP(model, wanted, 'time', t, 'load', L, 'drive_range', [-1e9 1e9]);
assert(max(free) > 0.5 && min(free) < 0);

% Wrong calls: an error with its identifier, and nothing moved.
block = sf_MKP('open', model);
sf_MKP(block, u(1:5), 'time', t(1:5), 'load', L(1:5));
before = sf_MKP('save', block);
inverse = sf_Inverse_MKP('open', model);
refused('hysteron:thermal', @() sf_MKP(block, u(6), 'load', 100));
refused('hysteron:thermal', @() sf_MKP(block, u(6), 'load', 100, 'time', 0.1));
refused('hysteron:thermal', @() sf_MKP(block, u(6:7), 'load', 100, 'time', [9 8]));
refused('hysteron:load', @() sf_MKP(block, u(6), 'time', 9));
refused('hysteron:load', @() sf_MKP(block, u(6:7), 'time', [9 10], 'load', [100 300]));
refused('hysteron:argument', @() sf_MKP(block, u(6:7), 'time', 9, 'load', 100));
refused('hysteron:argument', @() sf_MKP(block, u(6:8), 'time', [9 10 11], 'load', [100 100]));
refused('hysteron:argument', @() sf_MKP(block, u(6), 'time', 9, 'load', 100, 'start', 'on'));
refused('hysteron:argument', @() sf_MKP(model, u(6), 'load', 100, 'start', 'warm'));
refused('hysteron:notFinite', @() sf_MKP(block, u(6), 'time', NaN, 'load', 100));
refused('hysteron:notFinite', @() sf_MKP(block, u(6), 'time', 9, 'load', NaN));
refused('hysteron:argument', @() sf_MKP('temperature', model, 1));
refused('hysteron:block', @() sf_MKP('temperature', model));
refused('hysteron:argument', @() sf_Inverse_MKP(inverse, 1, 'load', 100, 'drive_range', 1));
refused('hysteron:argument', @() sf_Inverse_MKP(inverse, 1, 'load', 100, 'drive_range', [1 0]));
refused('hysteron:argument', @() sf_Inverse_MKP(inverse, 1, 'load', 100, 'horizon', -1));
refused('hysteron:notFinite', @() sf_Inverse_MKP(inverse, 1, 'load', 100, 'horizon', Inf));
wrong = before;
wrong.stages = 1:3;
refused('hysteron:argument', @() sf_MKP('restore', block, wrong));
wrong.stages = NaN(1, 7);
refused('hysteron:notFinite', @() sf_MKP('restore', block, wrong));
assert(isequal(sf_MKP('save', block), before));
clear sf_MKP sf_Inverse_MKP
printf('stages: time, load, start and limits, as whole signals and step by step\n');
end
