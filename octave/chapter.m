% CHAPTER  Replay the chapter's two simulation tests (its Fig. 9) and draw its Figs. 10 to 15.
%
%   CHAPTER(DEMO, FOLDER) takes model.json and recording-2.csv from the folder DEMO, which
%   `hysteron demo -o DEMO` makes. It sends the recorded temperature through sf_MKP and the recorded
%   displacement through sf_Inverse_MKP, prints the errors and writes fig10.png to fig15.png into
%   FOLDER. The chapter's own recording is not public: the demo's is simulated, and every figure
%   says so.
%
%   CHAPTER(DEMO, FOLDER, JSON) also compares the errors with those that `hysteron demo --json`
%   printed.
%
%   The chapter is "Hysteresis behaviour and modeling of SMA actuators", in Shape Memory Alloys, ed.
%   C. Cismasiu, 2010.
%
%   See also SF_MKP, SF_INVERSE_MKP.
function chapter(demo, folder, json)
model = fullfile(demo, 'model.json');
recording = dlmread(fullfile(demo, 'recording-2.csv'), ',', 1, 0);
[time, T, y] = deal(recording(:, 1), recording(:, 2), recording(:, 3));

% Fig. 9(a): the model; Fig. 9(b): its inverse. Reversals up to 1 % of the displacement's range are
% noise.
y_model = sf_MKP(model, T);
tolerance = 0.01 * (max(y) - min(y));
T_hold = sf_Inverse_MKP(model, y, 'tolerance', tolerance);
T_ahead = sf_Inverse_MKP(model, y, 'policy', 'anticipate', 'tolerance', tolerance);

found = [errors(y_model, y); errors(T_hold, T); errors(T_ahead, T)];
printf('simulated NiTi spring       RMSE   largest\n');
printf('sf_MKP               %8.4f mm  %8.4f mm\n', found(1, :));
printf('sf_Inverse_MKP hold  %8.4f degC%8.4f degC\n', found(2, :));
printf('  ... anticipate     %8.4f degC%8.4f degC\n', found(3, :));
if nargin > 2
    expected = jsondecode(fileread(json));
    all = {expected.forward, expected.inverse_hold.all, expected.inverse_anticipate.all};
    expected = cell2mat(cellfun(@(part) [part.rmse part.max_abs], all, 'UniformOutput', false)');
    % Sums in another order, and the tolerance rounded otherwise: the last digits differ.
    assert(all_close(found, expected, 1e-9), ...
        'chapter: other errors than those of hysteron demo');
    printf('as hysteron demo prints them\n');
end

if exist(folder, 'dir') ~= 7
    mkdir(folder);
end
degC = [char([194 176]) 'C'];
lines = struct('measured', [0.1 0.1 0.1], 'model', [0.85 0.33 0.1], 'ahead', [0.1 0.4 0.75]);

sheet('Modelled and recorded displacement over time', 'time (s)', 'displacement (mm)');
plot(time, y, 'color', lines.measured, time, y_model, 'color', lines.model);
finish(folder, 10, {'recorded (simulated spring)', 'sf_MKP'});

sheet('Displacement over temperature', ['temperature (' degC ')'], 'displacement (mm)');
plot(T, y, 'color', lines.measured, T, y_model, 'color', lines.model);
finish(folder, 11, {'recorded (simulated spring)', 'sf_MKP'});

sheet('Modelled less recorded displacement', 'time (s)', 'discrepancy (mm)');
bounds = [time([1 end]), time([1 end])];
plot(time, y_model - y, 'color', lines.model, ...
    bounds, [0.5 -0.5; 0.5 -0.5], '--', 'color', [0.5 0.5 0.5]);
finish(folder, 12, {'sf_MKP', 'bound of the chapter, 0.5 mm'});

sheet('Modelled and recorded temperature over time', 'time (s)', ['temperature (' degC ')']);
plot(time, T, 'color', lines.measured, time, T_hold, 'color', lines.model, ...
    time, T_ahead, 'color', lines.ahead);
policies = {'sf_Inverse_MKP, hold', 'sf_Inverse_MKP, anticipate'};
finish(folder, 13, [{'recorded (simulated spring)'}, policies]);

sheet('Modelled less recorded temperature', 'time (s)', ['discrepancy (' degC ')']);
plot(time, T_hold - T, 'color', lines.model, time, T_ahead - T, 'color', lines.ahead);
finish(folder, 14, policies);

% As in the chapter, the 150 seconds around the largest discrepancy of the policy that rests.
[~, worst] = max(abs(T_hold - T));
near = abs(time - time(worst)) <= 75;
sheet('Close-up of the dead band', 'time (s)', ['temperature (' degC '), displacement (mm)']);
t = time(near);
plot(t, T(near), 'color', lines.measured, t, T_hold(near), 'color', lines.model, ...
    t, T_ahead(near), 'color', lines.ahead, t, y(near), '--', 'color', lines.measured);
finish(folder, 15, ...
    [{'recorded temperature (simulated spring)'}, policies, {'recorded displacement'}]);
printf('figures 10 to 15 are in %s\n', folder);
end

% Root of the mean square, and largest.
function pair = errors(modelled, recorded)
error = modelled - recorded;
pair = [sqrt(mean(error .^ 2)), max(abs(error))];
end

function yes = all_close(a, b, tolerance)
yes = all(abs(a(:) - b(:)) <= tolerance * abs(b(:)));
end

% A figure that no window shows; in Octave gnuplot draws it, which needs no display.
function sheet(name, across, up)
if exist('OCTAVE_VERSION', 'builtin')
    warning('off', 'Octave:gnuplot-graphics', 'local');
    graphics_toolkit('gnuplot');
end
figure('visible', 'off', 'paperunits', 'inches', 'paperposition', [0 0 9 5]);
hold on;
box on;
grid on;
set(gca(), 'gridcolor', [0.8 0.8 0.8]);
title([name ' (simulated NiTi spring, 6 N)']);
xlabel(across);
ylabel(up);
end

function finish(folder, number, names)
legend(names, 'location', 'northeast', 'interpreter', 'none');
axis tight;
limits = ylim();
% Room for the legend above the curves.
ylim(limits + [-0.05 0.1 + 0.1 * numel(names)] * diff(limits));
print(fullfile(folder, sprintf('fig%d.png', number)), '-dpng', '-r120');
close();
end
